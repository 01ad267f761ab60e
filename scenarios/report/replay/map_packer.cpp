// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/replay/map_packer.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <map>

namespace plumbline::scenarios {

namespace {

constexpr double unit_m = 0.01, finest_voxel_m = 0.1;
constexpr double reach_m = 32767.0 * unit_m;
constexpr std::size_t most_read = 200'000;  ///< points; a page shows a tenth of them

using Voxels =
    std::map<std::array<int, 3>, Eigen::Vector3d>;  // by z, y, x: neighbours stand together, which deflates well

/// Of a large map every so many points, the same ones each time.
Voxels thinned(const std::vector<Eigen::Vector3f>& map_F, const Pose& X, double voxel_m) {
  const std::size_t every = (map_F.size() + most_read - 1) / most_read;
  Voxels voxels;
  for (std::size_t i = 0; i < map_F.size(); i += every) {
    const Eigen::Vector3d p = X * map_F[i].cast<double>();
    if (!(p.cwiseAbs().maxCoeff() < reach_m)) continue;
    const Eigen::Vector3d cell = (p / voxel_m).array().floor();
    voxels.try_emplace({static_cast<int>(cell.z()), static_cast<int>(cell.y()), static_cast<int>(cell.x())}, p);
  }
  return voxels;
}

}  // namespace

PackedMap pack_map(const std::vector<Eigen::Vector3f>& map_F, const Pose& X_WF, const Eigen::Vector3d& origin,
                   std::size_t most) {
  const Pose X{X_WF.q, X_WF.t - origin};
  PackedMap packed;
  packed.voxel_m = finest_voxel_m;
  Voxels voxels = thinned(map_F, X, packed.voxel_m);
  while (voxels.size() > most) {
    packed.voxel_m *= 1.3;
    voxels = thinned(map_F, X, packed.voxel_m);
  }
  packed.count = voxels.size();
  packed.bytes.assign(6 * packed.count, '\0');
  std::size_t i = 0;
  for (const auto& [cell, p] : voxels) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto cm = static_cast<std::int16_t>(std::lround(p[static_cast<Eigen::Index>(axis)] / unit_m));
      const auto bits = static_cast<std::uint16_t>(cm);
      const std::size_t at = axis * packed.count + i;
      packed.bytes[at] = static_cast<char>(bits & 0xFFU);
      packed.bytes[3 * packed.count + at] = static_cast<char>(bits >> 8U);
    }
    ++i;
  }
  return packed;
}

}  // namespace plumbline::scenarios
