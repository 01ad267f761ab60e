// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bim/config/visit.h"
#include "slam/localization/proposals.h"
#include "slam/localization/refine.h"

namespace plumbline::slam {

struct AliasSearchConfig {
  double spacing_m = 0.5;
  int max_places = 40000;
  int azimuths = 72;
  double range_max_m = 25.0;
  double room_tolerance_m = 0.3;
  double residual_cap_m = 1.0;
  double max_mean_m = 0.55;
  double min_inliers = 0.85;
  int count = 64;
  double gap_m = 0.6;
  double gap_rad = 0.35;
  double yaw_tolerance = 0.3;

  template <class V>
  void visit(V& v) {
    v("spacing_m", spacing_m, Field{.doc = "distance between the places that are compared", .min = 0.1});
    v("max_places", max_places,
      Field{.doc = "most places; they stand farther apart where there would be more", .min = 100, .max = 200000});
    v("azimuths", azimuths,
      Field{.doc = "rays of the horizontal range profile by which positions are compared", .min = 16, .max = 720});
    v("range_max_m", range_max_m, Field{.doc = "range at which these rays end", .min = 1});
    v("room_tolerance_m", room_tolerance_m,
      Field{.doc = "largest distance of the outlines of two rooms that are alike", .min = 0});
    v("residual_cap_m", residual_cap_m,
      Field{.doc = "difference of two ranges beyond which it counts no more", .min = 0});
    v("max_mean_m", max_mean_m, Field{.doc = "largest mean difference of a ring from that of the pose", .min = 0});
    v("min_inliers", min_inliers,
      share_field("least share of the beams predicted at the pose that the plan predicts at an alias, too"));
    v("count", count, Field{.doc = "most places of a storey that are looked at closely", .min = 1, .max = 10000});
    v("gap_m", gap_m, Field{.doc = "least distance between two of them", .min = 0});
    v("gap_rad", gap_rad, Field{.doc = "or least angle between two of them", .min = 0});
    v("yaw_tolerance", yaw_tolerance, Field{.doc = "largest difference from the prior yaw", .unit = "rad", .min = 0});
  }
};

/// Finds the poses from which the plan's structure looks as it does from a given one, whatever a scan says: clutter and
/// furniture hide neither of them. Candidates are its images in rooms of the same outline, and places whose level ring
/// of ranges is like its own; Gauss-Newton on the predicted beams fits them.
class AliasSearch {
 public:
  AliasSearch(const PlanIndex& index, double sensor_height, const AliasSearchConfig& config);

  /// Best first, without the pose itself. The scan gives the directions of the beams.
  [[nodiscard]] std::vector<StoreyPose> find(const PlanIndex& index, const StoreyPose& pose, const StartPrior& prior,
                                             const LocalizationScan& scan, const LikelihoodConfig& likelihood,
                                             const RefineConfig& refine) const;

  [[nodiscard]] std::size_t storeys() const { return storeys_.size(); }

 private:
  struct Places {
    std::vector<Eigen::Vector2d> sensor_I;
    std::vector<float> ranges;  ///< of all rings, one after another, from yaw 0 in I
  };
  [[nodiscard]] std::vector<float> ring(const StoreyIndex& storey, const Eigen::Vector2d& sensor_I, double yaw) const;
  [[nodiscard]] std::vector<ScoredPose> candidates(int storey, const std::vector<float>& wanted,
                                                   const StartPrior& prior, const Eigen::Vector2d& sensor_H) const;

  /// Images of the pose in the rooms that have the same outline, its own turned among them.
  [[nodiscard]] std::vector<StoreyPose> in_rooms_alike(const PlanIndex& index, const StoreyPose& pose,
                                                       const StartPrior& prior) const;

  AliasSearchConfig config_;
  double sensor_height_;
  std::vector<Places> storeys_;
};

}  // namespace plumbline::slam
