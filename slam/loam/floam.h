// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/config/visit.h"
#include "slam/loam/feature_map.h"
#include "slam/scan/beams.h"

namespace plumbline::slam::loam {

struct FloamConfig {
  Beams beam_model = Beams::automatic;
  FeatureConfig features;
  MapConfig map;
  int first_rounds = 12;
  int rounds = 2;

  template <class V>
  void visit(V& v) {
    v("beam_model", beam_model, beam_model_field);
    v("features", features);
    v("map", map);
    v("first_rounds", first_rounds,
      Field{.doc = "rounds of matching for the second scan; each later scan has one fewer, down to rounds", .min = 1});
    v("rounds", rounds, Field{.doc = "rounds of matching later", .min = 1, .basic = true});
  }
};

/// F-LOAM [wang2021]: each scan's features straight against the feature map, from where constant velocity would take
/// the robot. Odometry is not used.
class FloamOdometry {
 public:
  explicit FloamOdometry(const FloamConfig& config)
      : config_(config), beams_(config.beam_model), map_(config.map), rounds_(config.first_rounds) {}

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
  FloamConfig config_;
  BeamsOfRecording beams_;
  FeatureMap map_;
  ThinFeatures scan_;  ///< of the scan last matched
  int rounds_;
  Pose X_MR_;
  Pose X_LR_;  ///< latest step: this scan's pose in the one before
};

}  // namespace plumbline::slam::loam
