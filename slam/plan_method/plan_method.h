// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "slam/plan_method/plan_localization.h"

namespace plumbline::slam {

/// A pose hypothesis at the stamp of the last update.
struct PlanHypothesis {
  double mass = 1.0;
  int storey = 0;  ///< index into PlanIndex::storeys
  Pose X_IR;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< of (x, y, yaw) in I
  std::vector<WallMatch> walls = {};                         ///< shown with the scan they were found in
};

struct PlanBelief {
  State state = State::searching;
  std::optional<Pose> X_IR;  ///< the single answer, if there is one
  std::vector<PlanHypothesis> hypotheses;
  ParticleSet particles;
};

/// A localization that gives its belief at each update; it is propagated by odometry until the next one. The methods of
/// comparison derive from it.
class PlanMethod : public PlanLocalization {
 public:
  using PlanLocalization::PlanLocalization;

 protected:
  /// Processes a scan; its stages go into the output's digests and times.
  [[nodiscard]] virtual PlanBelief update(const PlanScan& scan, Output& output) = 0;

 private:
  void use_scan(const PlanScan& scan, Output& output) final;
  void report(const Pose& X_OR, Output& output) final;

  PlanBelief belief_;
  std::optional<Pose> X_IO_;  ///< by the last single answer
};

}  // namespace plumbline::slam
