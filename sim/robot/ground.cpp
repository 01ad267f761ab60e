// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/ground.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "bim/errors.h"

namespace plumbline::sim {

namespace {

Eigen::AlignedBox2d extent(const CollisionBox& box) {
  const Eigen::Vector3d reach = box.X_WB.rotation().cwiseAbs() * box.half;
  return {(box.X_WB.t - reach).head<2>(), (box.X_WB.t + reach).head<2>()};
}

/// Height of a box's upper side at p_W, or minus infinity beside it.
double top_at(const CollisionBox& box, const Eigen::Vector2d& p_W) {
  constexpr double none = -std::numeric_limits<double>::infinity();
  const Eigen::Vector3d up_W = box.X_WB.q * Eigen::Vector3d::UnitZ();
  const Eigen::Vector2d off = p_W - box.X_WB.t.head<2>();
  const double z = box.X_WB.t.z() + (box.half.z() - up_W.head<2>().dot(off)) / up_W.z();
  const Eigen::Vector3d p_B = box.X_WB.q.conjugate() * (Eigen::Vector3d(p_W.x(), p_W.y(), z) - box.X_WB.t);
  return (p_B.head<2>().cwiseAbs() - box.half.head<2>()).maxCoeff() <= 1e-9 ? z : none;
}

}  // namespace

Ground::Ground(double floor_z_W) : levels_{{floor_z_W, {}}} {}

Ground::Ground(std::vector<GroundLevel> levels, std::vector<CollisionBox> surfaces, const WellConfig& config)
    : config_(config), levels_(std::move(levels)), surfaces_(std::move(surfaces)) {
  if (levels_.empty()) throw InternalError("a ground without a level");
  for (const CollisionBox& box : surfaces_) extents_W_.push_back(extent(box));
}

bool Ground::has_plane_at(const GroundLevel& level, const Eigen::Vector2d& p_W) const {
  return std::all_of(level.wells_W.begin(), level.wells_W.end(),
                     [&](const auto& well) { return well.exteriorDistance(p_W) > config_.plane_from_m; });
}

double Ground::plane_height(const Eigen::Vector3d& p_W) const {
  for (auto level = levels_.rbegin(); level != levels_.rend(); ++level)
    if (level->z_m <= p_W.z() && has_plane_at(*level, p_W.head<2>())) return level->z_m;
  return levels_.front().z_m;
}

double Ground::height(double x, double y, double z_max) const {
  const Eigen::Vector2d p_W(x, y);
  double best = plane_height({x, y, z_max});
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    if (!extents_W_[i].contains(p_W)) continue;
    const double z = top_at(surfaces_[i], p_W);
    if (z <= z_max && z > best) best = z;
  }
  return best;
}

}  // namespace plumbline::sim
