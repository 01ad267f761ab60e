// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/loam/aloam.h"

#include <utility>

namespace plumbline::slam::loam {

Registration AloamOdometry::update(const DeskewedScan& scan, const Pose& /*X_OR*/) {
  Features features = find_features(scan, config_.features);
  const ThinFeatures thinned = thin(features, config_.map);
  Registration result;
  if (!map_.empty()) {
    X_LR_ = align_scans(features, last_, X_LR_, config_.scan_to_scan);
    result = map_.align(thinned, X_MR_ * X_LR_, config_.rounds);
  }
  X_MR_ = result.X_MR;
  map_.add(thinned, X_MR_);
  last_ = std::move(features);
  return result;
}

}  // namespace plumbline::slam::loam
