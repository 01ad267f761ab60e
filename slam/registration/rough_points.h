// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <deque>
#include <memory>
#include <span>
#include <vector>

#include "bim/geometry/pose.h"
#include "slam/registration/registration.h"
#include "slam/scan/kd_tree.h"

namespace plumbline::slam {

/// A rough point of a scan and the point of the map that it is taken for.
struct RoughMatch {
  Eigen::Vector3d p_R;
  Eigen::Vector3d p_M;
};

/// Rough points, as of leaves and posts, of the latest keyframes in M. No surface goes through them, so that they are
/// matched point to point [besl1992]: coarse, yet all there is where surfaces leave a direction open.
class RoughMap {
 public:
  /// Adds a keyframe's points; those of all but the latest `keep` keyframes go.
  void add(std::vector<Eigen::Vector3d> points_R, const Pose& X_MR, std::size_t keep);
  [[nodiscard]] bool empty() const { return !tree_ || tree_->points().empty(); }
  /// Each point with its nearest in the map, where that lies within reach_m.
  [[nodiscard]] std::vector<RoughMatch> match(std::span<const Eigen::Vector3d> points_R, const Pose& X_MR,
                                              double reach_m) const;

 private:
  std::deque<std::vector<Eigen::Vector3d>> keyframes_;  ///< M
  std::shared_ptr<const KdTree> tree_;                  ///< shared by copies until they add points
};

/// Normal equations of all distances under a Cauchy kernel, by the right increment. sigma_m: of one.
[[nodiscard]] Normal6 linearize(std::span<const RoughMatch> matches, const Pose& X_MR, double sigma_m);

}  // namespace plumbline::slam
