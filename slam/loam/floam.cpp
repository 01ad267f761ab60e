// SPDX-License-Identifier: Apache-2.0
#include "slam/loam/floam.h"

#include <algorithm>
#include <optional>

namespace plumbline::slam::loam {

Registration FloamOdometry::match(const DeskewedScan& scan, const OdometrySample& /*odometry*/,
                                  double /*usual_matched*/) {
  const std::optional<DeskewedScan> in_rings = beams_.in_rings(scan);
  scan_ = thin(find_features(in_rings ? *in_rings : scan, config_.features), config_.map);
  Registration result;
  result.X_MR = X_MR_;
  if (!ready()) return result;
  result = map_.align(scan_, X_MR_ * X_LR_, rounds_);
  rounds_ = std::max(rounds_ - 1, config_.rounds);
  return result;
}

void FloamOdometry::commit(const Pose& X_MR, bool mapped) {
  if (ready()) X_LR_ = X_MR_.inverse() * X_MR;
  X_MR_ = X_MR;
  if (mapped) map_.add(scan_, X_MR_);
}

void FloamOdometry::reset_map() {
  map_ = FeatureMap(config_.map);
  rounds_ = config_.first_rounds;
}

}  // namespace plumbline::slam::loam
