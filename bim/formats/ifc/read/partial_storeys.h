// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/formats/ifc/step/step_model.h"

namespace plumbline::bim {

/// Storeys that are parts of another storey and lie at its height become that storey, with a warning: what is on them
/// belongs to it. Parts at another height stay storeys.
void join_partial_storeys(StepModel& model);

}  // namespace plumbline::bim
