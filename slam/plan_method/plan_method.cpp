// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_method/plan_method.h"

#include <utility>

namespace plumbline::slam {

void PlanMethod::use_scan(const PlanScan& scan, Output& output) {
  belief_ = update(scan, output);
  if (!belief_.X_IR) return;
  X_IO_ = *belief_.X_IR * scan.X_OR.inverse();
  add_correction(scan.deskewed.stamp, *X_IO_);
}

void PlanMethod::report(const Pose& X_OR, Output& output) {
  output.state = belief_.state;
  if (X_IO_) output.X_FR = index().X_WI * (*X_IO_ * X_OR);
  const Pose moved = X_OR_update() ? X_OR_update()->inverse() * X_OR : Pose{};
  for (PlanHypothesis& hypothesis : belief_.hypotheses) {
    const std::vector<WallMatch> walls = std::exchange(hypothesis.walls, {});
    if (!is_shown(hypothesis.mass)) continue;
    output.hypotheses.push_back(
        hypothesis_in_W(hypothesis.mass, hypothesis.storey, hypothesis.X_IR * moved, hypothesis.covariance));
    output.hypotheses.back().walls = walls;
  }
  report_particles(belief_.particles, heading(moved), output);
}

}  // namespace plumbline::slam
