// SPDX-License-Identifier: Apache-2.0
#include "slam/loam/aloam.h"

#include <optional>
#include <utility>

namespace plumbline::slam::loam {

Registration AloamOdometry::match(const DeskewedScan& scan, const OdometrySample& /*odometry*/,
                                  double /*usual_matched*/) {
  const std::optional<DeskewedScan> in_rings = beams_.in_rings(scan);
  scan_ = find_features(in_rings ? *in_rings : scan, config_.features);
  thinned_ = thin(scan_, config_.map);
  Registration result;
  result.X_MR = X_MR_;
  if (!ready()) return result;
  X_LR_ = align_scans(scan_, last_, X_LR_, config_.scan_to_scan);
  return map_.align(thinned_, X_MR_ * X_LR_, config_.rounds);
}

void AloamOdometry::commit(const Pose& X_MR, bool mapped) {
  if (!mapped) X_LR_ = X_MR_.inverse() * X_MR;
  X_MR_ = X_MR;
  if (mapped) map_.add(thinned_, X_MR_);
  last_ = std::move(scan_);
}

void AloamOdometry::reset_map() { map_ = FeatureMap(config_.map); }

}  // namespace plumbline::slam::loam
