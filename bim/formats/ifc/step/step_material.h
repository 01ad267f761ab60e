// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/formats/ifc/step/step_model.h"

class IfcProduct;

namespace plumbline::bim {

/// Fills layers and material of a product from its IfcRelAssociatesMaterial, or else the material from that of its
/// type.
void read_material(const IfcProduct& source, double unit_m, StepProduct& product);

}  // namespace plumbline::bim
