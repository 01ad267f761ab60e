// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/formats/ifc/step/step_geometry.h"
#include "bim/formats/ifc/step/step_model.h"
#include "bim/formats/ifc/step/step_validator.h"

class IfcProduct;

namespace plumbline::bim {

/// True when the file gives a product of this class a representation that may serve as its body.
[[nodiscard]] bool has_body(const IfcProduct& source, StepClass kind);

/// Fills the body of a product with the items of the first representation that has any: Body, for openings Reference,
/// or one without a name whose type is that of a solid. Throws InputError where its entities lack what IFC demands.
void read_body(const IfcProduct& source, StepValidator& validator, StepGeometry& geometry, StepProduct& product);

/// Fills the outline of a space: the first ring of its FootPrint, or else the rectangle of its bounding box on the
/// plan.
void read_outline(const IfcProduct& source, double unit_m, StepValidator& validator, StepGeometry& geometry,
                  StepProduct& product);

/// Fills the points of the Axis of a wall, in W.
void read_axis(const IfcProduct& source, StepValidator& validator, StepGeometry& geometry, StepProduct& product);

}  // namespace plumbline::bim
