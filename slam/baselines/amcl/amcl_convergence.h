// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "slam/baselines/amcl/amcl_filter.h"
#include "slam/particles/pose_clusters.h"

namespace plumbline::slam {

/// Whether a set of particles is one answer, on one storey, by ConvergedBy; yaw does not count. A cluster is kept with
/// less mass than it takes to become the answer. Where the heaviest cluster is another one than before, it has to
/// become the answer anew.
class AmclConvergence {
 public:
  explicit AmclConvergence(const AmclFilterConfig& config) : config_(config) {}

  /// Of the set at a scan, its clusters and the motion since the scan before.
  void update(const ParticleSet& particles, const Clustering& clustering, const Pose2& u);
  [[nodiscard]] bool converged() const { return answer_.has_value(); }

 private:
  [[nodiscard]] bool whole_set_agrees(const ParticleSet& particles) const;
  [[nodiscard]] bool cluster_agrees(const PoseCluster& heaviest, const Pose2& u) const;

  AmclFilterConfig config_;
  std::optional<Pose2> answer_;  ///< X_IH, mean of the cluster that is the answer
};

/// Mean and covariance of (x, y, yaw) of a whole set, weights as they are; yaw is the circular mean.
struct SetMoments {
  Pose2 mean;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};
[[nodiscard]] SetMoments moments_of(const ParticleSet& particles);

}  // namespace plumbline::slam
