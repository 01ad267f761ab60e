// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/formats/ifc/step/step_model.h"

namespace plumbline::bim {

/// Leaves out all but the first of elements of one class with the same body, to a millimetre, that are parts of the
/// same and cut or fill the same. What cut, filled or was a part of one that is left out belongs to the first.
void leave_out_doubles(StepModel& model);

}  // namespace plumbline::bim
