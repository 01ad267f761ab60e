// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/formats/ifc/step/step_model.h"

class IfcProduct;

namespace plumbline::bim {

/// What the attributes of a product say of it by themselves: its name, what a space or covering is for, the elevation
/// of a storey, the size of a door or window.
void read_said(const IfcProduct& source, double unit_m, StepProduct& product);

/// Space kept free for an opening to come: a body without matter.
[[nodiscard]] bool is_provision(const IfcProduct& product);

}  // namespace plumbline::bim
