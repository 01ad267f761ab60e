// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

#include "slam/baselines/pcl_registration/pcl_matcher.h"

namespace plumbline::slam {

/// A matcher by a class of PCL and its clouds: this header includes nothing of PCL. needed: points on either side, if
/// more than least_points.
template <class Registration, class Cloud>
class MatcherBy final : public PclMatcher {
 public:
  using MakeCloud = Cloud (*)(std::span<const Eigen::Vector3d>);

  MatcherBy(double matched_m, std::size_t needed, MakeCloud make_cloud)
      : matched_m2_(static_cast<float>(matched_m * matched_m)),
        needed_(std::max(needed, least_points)),
        make_cloud_(make_cloud) {}

  [[nodiscard]] Registration& registration() { return registration_; }

  void set_target(std::span<const Eigen::Vector3d> points_T) override {
    targets_ = points_T.size();
    if (targets_ >= needed_) registration_.setInputTarget(std::make_shared<const Cloud>(make_cloud_(points_T)));
  }

  [[nodiscard]] PclMatch match(std::span<const Eigen::Vector3d> points_S, const Pose& X_TS) override {
    PclMatch result{X_TS};
    if (targets_ < needed_ || points_S.size() < needed_) return result;
    registration_.setInputSource(std::make_shared<const Cloud>(make_cloud_(points_S)));
    Eigen::Matrix4d guess = Eigen::Matrix4d::Identity();
    guess.topLeftCorner<3, 3>() = X_TS.rotation();
    guess.topRightCorner<3, 1>() = X_TS.t;
    Cloud moved_T;
    registration_.align(moved_T, guess.cast<float>());
    const Eigen::Matrix4d found = registration_.getFinalTransformation().template cast<double>();
    if (!registration_.hasConverged() || !found.allFinite()) return result;
    const Eigen::Matrix3d R = found.topLeftCorner<3, 3>();
    result.X_TS = {Eigen::Quaterniond(R).normalized(), found.topRightCorner<3, 1>()};
    result.converged = true;
    if (matched_m2_ > 0.0F) result.matched = matched_share(moved_T);
    return result;
  }

 private:
  [[nodiscard]] double matched_share(const Cloud& moved_T) const {
    std::vector<int> index(1);
    std::vector<float> distance2(1);
    std::size_t near = 0;
    const auto tree = registration_.getSearchMethodTarget();
    for (const auto& point : moved_T)
      if (tree->nearestKSearch(point, 1, index, distance2) == 1 && distance2[0] <= matched_m2_) ++near;
    return static_cast<double>(near) / static_cast<double>(moved_T.size());
  }

  Registration registration_;
  float matched_m2_;
  std::size_t needed_;
  MakeCloud make_cloud_;
  std::size_t targets_ = 0;
};

}  // namespace plumbline::slam
