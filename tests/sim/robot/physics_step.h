// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sim/robot/model.h"

namespace plumbline::sim {

inline constexpr double step_s = ModelConfig{}.step_s;

}  // namespace plumbline::sim
