// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace plumbline::sim {

/// Height of the floor a foot would find under (x, y) at or below `z_max`, m in W.
using Terrain = std::function<double(double x, double y, double z_max)>;

}  // namespace plumbline::sim
