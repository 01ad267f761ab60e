// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/config/visit.h"
#include "slam/loam/feature_map.h"
#include "slam/loam/scan_to_scan.h"
#include "slam/scan/beams.h"

namespace plumbline::slam::loam {

struct AloamConfig {
  Beams beam_model = Beams::automatic;
  FeatureConfig features;
  ScanToScanConfig scan_to_scan;
  MapConfig map;
  int rounds = 2;

  template <class V>
  void visit(V& v) {
    v("beam_model", beam_model, beam_model_field);
    v("features", features);
    v("scan_to_scan", scan_to_scan);
    v("map", map);
    v("rounds", rounds, Field{.doc = "rounds of matching against the map", .min = 1, .basic = true});
  }
};

/// A-LOAM [qin2018]: scan to scan first, then that motion refined against the feature map. Every scan is mapped.
/// Odometry is not used.
class AloamOdometry {
 public:
  explicit AloamOdometry(const AloamConfig& config)
      : config_(config), beams_(config.beam_model, lowest_of_64), map_(config.map) {}

  /// Registers the scan. Odometry is not used.
  [[nodiscard]] Registration match(const DeskewedScan& scan, const OdometrySample& odometry,
                                   double usual_matched = 0.0);
  /// Takes it in at X_MR, into the map only if `mapped`.
  void commit(const Pose& X_MR, bool mapped);
  /// Whether there is a map to match against.
  [[nodiscard]] bool ready() const { return !map_.empty(); }
  /// Drops the map.
  void reset_map();

 private:
  static constexpr int lowest_of_64 = 13;  ///< as the reference, which uses the upper 51 of them

  AloamConfig config_;
  BeamsOfRecording beams_;
  Features last_;
  Features scan_;  ///< of the scan last matched
  ThinFeatures thinned_;
  FeatureMap map_;
  Pose X_MR_;
  Pose X_LR_;  ///< latest step, scan to scan: this scan's pose in the one before
};

}  // namespace plumbline::slam::loam
