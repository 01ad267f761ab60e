// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/loam/floam.h"

#include <algorithm>

namespace plumbline::slam::loam {

Registration FloamOdometry::update(const DeskewedScan& scan, const Pose& /*X_OR*/) {
  const ThinFeatures features = thin(find_features(scan, config_.features), config_.map);
  Registration result;
  if (!map_.empty()) {
    result = map_.align(features, X_MR_ * X_LR_, rounds_);
    rounds_ = std::max(rounds_ - 1, config_.rounds);
    X_LR_ = X_MR_.inverse() * result.X_MR;
  }
  X_MR_ = result.X_MR;
  map_.add(features, X_MR_);
  return result;
}

}  // namespace plumbline::slam::loam
