// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/box_pool.h"

#include <algorithm>
#include <string>
#include <utility>

#include "bim/errors.h"

namespace plumbline::sim {

namespace {

/// Where unused boxes wait: far below every floor, and small.
constexpr double parked_z_m = -50.0;
constexpr double parked_half_m = 0.01;
const Eigen::Vector4d no_rotation(1.0, 0.0, 0.0, 0.0);

}  // namespace

BoxPool::BoxPool(std::vector<CollisionBox> boxes, std::vector<int> geoms, double radius_m)
    : boxes_(std::move(boxes)), geoms_(std::move(geoms)), radius_m_(radius_m) {
  std::sort(boxes_.begin(), boxes_.end(), [](const CollisionBox& a, const CollisionBox& b) { return a.id < b.id; });
}

void BoxPool::refresh(mjModel_& model, const Eigen::Vector3d& p_W) const {
  std::size_t used = 0;
  for (const CollisionBox& box : boxes_) {
    if (distance(box, p_W) > radius_m_) continue;
    if (used == geoms_.size())
      throw InternalError("more than " + std::to_string(geoms_.size()) + " collision boxes near the robot");
    const Eigen::Quaterniond& q = box.X_WB.q;
    place_box(model, geoms_[used++], box.X_WB.t, {q.w(), q.x(), q.y(), q.z()}, box.half);
  }
  for (; used < geoms_.size(); ++used)
    place_box(model, geoms_[used], {0.0, 0.0, parked_z_m}, no_rotation, Eigen::Vector3d::Constant(parked_half_m));
}

}  // namespace plumbline::sim
