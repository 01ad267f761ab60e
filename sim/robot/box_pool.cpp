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
/// What the robot can touch before the next refresh: half its length and 0.5 s of the fastest walk.
constexpr double touch_m = 1.0;
const Eigen::Vector4d no_rotation(1.0, 0.0, 0.0, 0.0);

}  // namespace

BoxPool::BoxPool(std::vector<CollisionBox> boxes, std::vector<int> geoms, double radius_m)
    : boxes_(std::move(boxes)), geoms_(std::move(geoms)), radius_m_(radius_m) {
  std::sort(boxes_.begin(), boxes_.end(), [](const CollisionBox& a, const CollisionBox& b) { return a.id < b.id; });
}

std::vector<std::size_t> BoxPool::near(const Eigen::Vector3d& p_W) const {
  std::vector<std::pair<double, std::size_t>> found;
  for (std::size_t i = 0; i < boxes_.size(); ++i)
    if (const double d = distance(boxes_[i], p_W); d <= radius_m_) found.emplace_back(d, i);
  if (found.size() > geoms_.size()) {
    std::sort(found.begin(), found.end());
    if (found[geoms_.size()].first < touch_m)
      throw ScenarioFailure("more than " + std::to_string(geoms_.size()) +
                            " collision boxes within the robot's reach; the world is too finely cluttered there");
    found.resize(geoms_.size());
  }
  std::vector<std::size_t> order;
  for (const auto& [d, i] : found) order.push_back(i);
  std::sort(order.begin(), order.end());
  return order;
}

void BoxPool::refresh(mjModel_& model, const Eigen::Vector3d& p_W) const {
  std::size_t used = 0;
  for (const std::size_t i : near(p_W)) {
    const CollisionBox& box = boxes_[i];
    const Eigen::Quaterniond& q = box.X_WB.q;
    place_box(model, geoms_[used++], box.X_WB.t, {q.w(), q.x(), q.y(), q.z()}, box.half);
  }
  for (; used < geoms_.size(); ++used)
    place_box(model, geoms_[used], {0.0, 0.0, parked_z_m}, no_rotation, Eigen::Vector3d::Constant(parked_half_m));
}

}  // namespace plumbline::sim
