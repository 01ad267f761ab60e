// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "slam/localization/global_localizer.h"
#include "slam/localization/pipeline.h"

namespace plumbline::slam {

/// Whether a robot that is tracked might stand elsewhere in the plan: the tracked pose is compared with others that
/// explain the scans.
class Alternatives {
 public:
  explicit Alternatives(const LocalizationConfig& config);

  /// Forgets the scans, which no longer lead to the present pose.
  void clear();

  struct Tracked {
    StoreyPose pose;
    const Agreement& agreement;  ///< moving average over scans
  };
  struct Step {
    Pose2 u;  ///< motion since the scan before
    const LocalizationScan& scan;
  };
  /// Each scan. True when another hypothesis explains the last scans better at two checks in a row: where a wall of the
  /// plan is missing, many do for a while.
  [[nodiscard]] bool is_one_better(const PlanIndex& index, const Tracked& tracked, const Step& step,
                                   const std::optional<ExpectedYaw>& yaw, GlobalLocalizer& search);

  /// Whether another pose explains a scan about as well, of a robot that may have been carried. Forgets the scans
  /// before.
  [[nodiscard]] bool may_stand_elsewhere(const PlanIndex& index, const StoreyPose& tracked,
                                         const LocalizationScan& scan, GlobalLocalizer& search);

 private:
  [[nodiscard]] bool is_same(const PoseHypothesis& hypothesis, const StoreyPose& tracked) const;
  void find(const PlanIndex& index, const StoreyPose& tracked, const LocalizationScan& scan, GlobalLocalizer& search);

  KidnapMonitorConfig config_;
  GlobalLocalizerConfig search_;
  HypothesisSet hypotheses_;  ///< by the last scans; any only while a check runs
  double since_check_m_ = 0.0;
};

}  // namespace plumbline::slam
