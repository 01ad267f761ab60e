// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "bim/config/visit.h"
#include "slam/graph/graph.h"
#include "slam/registration/vgicp.h"

namespace plumbline::slam {

struct LoopConfig {
  double radius_m = 3.0;
  double min_walked_m = 10.0;
  double min_since_last_m = 2.0;
  int map_keyframes = 2;
  double voxel_m = 0.5;
  double min_matched = 0.7;
  double max_rms = 1.5;
  double max_shift_m = 0.3;
  double max_shift_per_m = 0.01;
  double max_turn_rad = 0.1;
  double inflation = 50.0;
  double sigma_m = 0.015;
  double sigma_rad = 0.004;
  SurfelConfig surfels{.max_range_m = 30.0};  // poses of keyframes far off turn what is far by metres
  RegistrationConfig registration;

  template <class V>
  void visit(V& v) {
    v("radius_m", radius_m,
      Field{.doc = "largest distance between the two keyframes of a loop candidate", .min = 0, .basic = true});
    v("min_walked_m", min_walked_m, Field{.doc = "least distance walked between the two keyframes", .min = 0});
    v("min_since_last_m", min_since_last_m, Field{.doc = "least distance walked since the last attempt", .min = 0});
    v("map_keyframes", map_keyframes,
      Field{.doc = "neighbours on each side of the old keyframe that enter its map", .min = 0});
    v("voxel_m", voxel_m, Field{.doc = "voxel size of that map", .min = 0.05});
    v("min_matched", min_matched, share_field("least share of surfels that match"));
    v("max_rms", max_rms, plain_field("largest RMS of the matches' Mahalanobis distances", {.min = 0}));
    v("max_shift_m", max_shift_m, Field{.doc = "largest correction of the position that is accepted", .min = 0});
    v("max_shift_per_m", max_shift_per_m,
      Field{.doc = "correction that is accepted besides, per metre walked between the keyframes",
            .unit = "m/m",
            .min = 0});
    v("max_turn_rad", max_turn_rad, Field{.doc = "largest correction of the attitude that is accepted", .min = 0});
    v("inflation", inflation,
      plain_field("factor on the registration's covariance: neighbouring surfels are not independent", {.min = 1}));
    v("sigma_m", sigma_m,
      Field{.doc = "standard deviation of the position, added: what averaging cannot remove", .min = 1e-4});
    v("sigma_rad", sigma_rad, Field{.doc = "standard deviation of the attitude, added", .min = 1e-5});
    v("surfels", surfels, Field{.advanced = true});
    v("registration", registration);
  }
};

/// Hard loop closure [bavle2023, section IV-E]: the newest keyframe is matched against an old one nearby.
class LoopClosure {
 public:
  explicit LoopClosure(const LoopConfig& config) : config_(config) {}

  /// Adds the newest keyframe's scan; walked_m: length of the way so far. A factor when a loop was verified.
  [[nodiscard]] std::optional<PoseFactor> update(const Graph& graph, const DeskewedScan& scan, double walked_m);

 private:
  struct Entry {
    std::vector<Surfel> surfels;
    double walked_m = 0.0;
  };

  /// The nearest old keyframe (ties: lower id), or none.
  [[nodiscard]] std::optional<int> candidate(const Graph& graph) const;
  [[nodiscard]] std::optional<PoseFactor> verify(const Graph& graph, int old) const;

  LoopConfig config_;
  std::vector<Entry> entries_;  ///< index = keyframe
  double last_attempt_m_ = 0.0;
};

/// Covariance of a registration with regard to its correlations: inflation * H^-1 + added, where H gets a weak prior so
/// that a direction it did not see comes out as unknown. Returns the information.
[[nodiscard]] Matrix6d trusted_information(const Matrix6d& hessian, double inflation, double sigma_m, double sigma_rad);

}  // namespace plumbline::slam
