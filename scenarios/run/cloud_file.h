// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

namespace plumbline::scenarios {

/// Binary little-endian PLY with float x, y, z.
[[nodiscard]] std::string write_ply(const std::vector<Eigen::Vector3f>& points);
/// Reads what write_ply writes; anything else is an InputError.
[[nodiscard]] std::vector<Eigen::Vector3f> read_ply(std::string_view bytes, const std::string& file);

}  // namespace plumbline::scenarios
