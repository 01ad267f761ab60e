// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "bim/config/visit.h"
#include "bim/geometry/pose.h"
#include "slam/registration/correlation.h"
#include "slam/registration/registration.h"
#include "slam/registration/rough_points.h"
#include "slam/registration/surfels.h"
#include "slam/registration/upright_edges.h"

namespace plumbline::slam {

struct VgicpConfig {
  SurfelConfig surfels;
  /// The slack along a surface is what a voxel of the map spans. On stairs anything blunter takes soffit, treads and
  /// landing for one surface: with voxels of 0.5 m and agreement 0.5 the attitude was lost there.
  RegistrationConfig registration{.sigma_tangent_m = 0.2, .min_normal_agreement = 0.9, .cauchy_scale = 1.5};
  EdgeConfig edges;
  bool rough_points = true;
  bool correlation = true;
  double map_voxel_m = 0.2;
  double keyframe_distance_m = 0.5;
  double keyframe_angle_rad = 0.35;
  int map_keyframes = 20;
  bool odometry_prior = true;
  double prior_m = 0.004;
  double prior_per_m = 0.05;
  double prior_rad = 0.004;
  double prior_per_rad = 0.05;
  bool tilt_prior = true;
  double tilt_rad = 0.01;
  double reference_range_m = 6.0;
  double largest_scale = 6.0;
  int coarse_levels = 2;
  int coarse_share = 4;

  template <class V>
  void visit(V& v) {
    v("surfels", surfels);
    v("registration", registration);
    v("edges", edges);
    v("rough_points", rough_points,
      Field{.doc = "match points without a surface, as of leaves, in directions that nothing else measures"});
    v("correlation", correlation,
      Field{.doc = "search in these directions for where returns that stand on the ground meet those of an earlier "
                   "keyframe"});
    v("map_voxel_m", map_voxel_m, Field{.doc = "voxel size of the local map", .min = 0.05, .basic = true});
    v("keyframe_distance_m", keyframe_distance_m,
      Field{.doc = "distance after which a scan enters the local map", .min = 0.01, .basic = true});
    v("keyframe_angle_rad", keyframe_angle_rad,
      Field{.doc = "or turn after which a scan enters the local map", .min = 0.01});
    v("map_keyframes", map_keyframes, Field{.doc = "latest keyframes that make up the local map", .min = 1});
    // A weak factor, which helps along bare corridors.
    v("odometry_prior", odometry_prior,
      Field{.doc = "constrain the motion by leg odometry's increments", .basic = true});
    v("prior_m", prior_m, Field{.doc = "least standard deviation of an increment's translation", .min = 1e-5});
    v("prior_per_m", prior_per_m,
      Field{.doc = "standard deviation of an increment's translation per metre", .unit = "m/m", .min = 0.0});
    v("prior_rad", prior_rad, Field{.doc = "least standard deviation of an increment's rotation", .min = 1e-6});
    v("prior_per_rad", prior_per_rad,
      Field{.doc = "standard deviation of an increment's rotation per radian", .unit = "rad/rad", .min = 0.0});
    v("tilt_prior", tilt_prior,
      Field{.doc = "hold roll and pitch to the odometry's, which do not drift: an IMU senses gravity"});
    v("tilt_rad", tilt_rad, Field{.doc = "standard deviation of the odometry's roll and pitch", .min = 1e-5});
  }
};

/// As VGICP is usually set: voxels of half a metre, and a wider Cauchy kernel.
struct CoarseVgicpConfig : VgicpConfig {
  CoarseVgicpConfig() {
    map_voxel_m = 0.5;
    registration = {.sigma_tangent_m = 0.5, .min_normal_agreement = 0.8, .cauchy_scale = 2.0};
    edges.enabled = false;
    rough_points = false;
    correlation = false;
  }
};

/// LiDAR odometry: each scan against a local map of the latest keyframes. M starts at the first pose: X_MR = identity.
class VgicpOdometry {
 public:
  explicit VgicpOdometry(const VgicpConfig& config);

  /// X_OR: leg odometry at scan.stamp, in a frame whose z is up: its increments are start and prior, its tilt a prior;
  /// neither is used where odometry is not valid.
  [[nodiscard]] Registration update(const DeskewedScan& scan, const Pose& X_OR);
  /// First half of update(): registers the scan. If fewer than `usual_matched` of its surfels match, coarser maps are
  /// tried first, from several starts.
  [[nodiscard]] Registration match(const DeskewedScan& scan, const OdometrySample& odometry,
                                   double usual_matched = 0.0);
  /// Second half of update(): stores the scan at X_MR, in the map only if `mapped`.
  void commit(const Pose& X_MR, bool mapped);
  /// Whether there is a map to match against.
  [[nodiscard]] bool ready() const { return !keyframes_.empty(); }
  /// The local map, finest voxels first, without a scan that was not yet committed.
  [[nodiscard]] const std::vector<SurfelMap>& maps() const { return maps_; }
  /// The last matched scan by its surfels alone against such a map, from `start`.
  [[nodiscard]] Registration place_in(std::span<const SurfelMap> maps, const Pose& start) const;
  /// Whether poses are within the reach of the coarsest map from one another.
  [[nodiscard]] bool is_near(const Pose& a, const Pose& b) const;
  /// Drops the map.
  void reset_map();
  /// True when the last scan entered the local map.
  [[nodiscard]] bool is_keyframe() const { return is_keyframe_; }

 private:
  /// Of one scan.
  struct ScanFeatures {
    std::vector<Surfel> surfels;
    std::vector<Surfel> registered;  ///< those that are matched, evenly spread where there are many ...
    std::vector<Surfel> subsample;   ///< ... and a share of these
    std::vector<Eigen::Vector3d> edges_R;
    std::vector<Eigen::Vector3d> rough_R;
    std::vector<Eigen::Vector3d> returns_R;  ///< thinned, where they were asked for
    RegistrationConfig fine;
  };
  struct Keyframe {
    std::vector<Surfel> surfels;
    Pose X_MR;
    Nanoseconds stamp = 0;
    bool measured = false;  ///< in all directions
    ReturnVoxels returns;
  };

  [[nodiscard]] PosePrior predict(const DeskewedScan& scan, const OdometrySample& odometry) const;
  /// By surfels and edges; align_finely() also by rough points, in directions that these leave open.
  [[nodiscard]] Registration align_surfaces(const Pose& start, const std::optional<PosePrior>& prior,
                                            const OdometrySample& odometry) const;
  [[nodiscard]] Registration align_finely(const Pose& start, const std::optional<PosePrior>& prior,
                                          const OdometrySample& odometry) const;
  /// Factors of the scan's edges and the lines of the map that they are near to there.
  [[nodiscard]] AdditionalFactors edges_near(const Pose& X_MR) const;
  /// Goes on from a place whose unobserved directions rough points may tell, sought as far as they seem to be off, or
  /// within these reaches in turn.
  [[nodiscard]] Registration with_rough_points(Registration found, const Pose& expected,
                                               const std::optional<PosePrior>& prior,
                                               const OdometrySample& odometry) const;
  [[nodiscard]] Registration with_rough_points_within(std::span<const double> reaches_m, Registration found,
                                                      const Pose& expected, const std::optional<PosePrior>& prior,
                                                      const OdometrySample& odometry) const;
  [[nodiscard]] std::vector<double> rough_reaches(const Pose& X_MR) const;
  /// Goes on from a place whose unobserved directions an earlier keyframe may tell.
  [[nodiscard]] std::optional<Registration> align_correlated(const DeskewedScan& scan, const Registration& found,
                                                             const std::optional<PosePrior>& prior,
                                                             const OdometrySample& odometry) const;
  /// From a place that tells these movements.
  [[nodiscard]] Registration align_known(const Pose& expected, std::span<const Vector6d> movements,
                                         const std::optional<PosePrior>& prior, const OdometrySample& odometry) const;
  /// The latest keyframe that is far enough from there to tell a motion from a standstill, if possible one that was
  /// measured; else the latest.
  [[nodiscard]] const Keyframe& keyframe_apart_from(const Pose& X_MR) const;
  [[nodiscard]] std::vector<Eigen::Vector3d> returns_of(const DeskewedScan& scan) const;
  [[nodiscard]] bool is_new_view(const Pose& X_MR) const;
  /// Whether what is not known of the motion during the scan moves what it sees, not nearer than in a room, by more
  /// than its least_bend_m.
  [[nodiscard]] bool bends(const DeskewedScan& scan) const;
  /// Corrects the scan by the motion during it that its deskewing did not know, and places it again.
  void correct_sweep(const DeskewedScan& scan, const std::optional<PosePrior>& prior, const OdometrySample& odometry,
                     Registration& result);
  [[nodiscard]] ScanFeatures features_of(const DeskewedScan& scan) const;
  /// The start that leads to the most matches in coarse maps, and where it leads.
  [[nodiscard]] Registration align_coarsely(std::span<const Pose> starts) const;
  void insert(const Pose& X_MR);
  /// Follows the scene's scale: all sizes change by steps, since the map is made anew.
  void follow_scale(const DeskewedScan& scan);
  void set_scale(double scale);

  VgicpConfig config_;
  SurfelConfig surfels_;             ///< at the scene's scale
  RegistrationConfig registration_;  ///< likewise
  std::vector<SurfelMap> maps_;      ///< finest first
  EdgeMap edge_map_;
  RoughMap rough_map_;
  std::deque<Keyframe> keyframes_;
  ScanFeatures scan_;                       ///< last matched ...
  Nanoseconds stamp_ = 0;                   ///< ... its stamp ...
  bool is_measured_ = false;                ///< ... and whether its whole pose was measured
  double moving_share_ = 0.0;               ///< of the latest scans, those that showed something move
  double median_range_m_ = 0.0;             ///< low-pass filtered; 0 before the first scan
  std::optional<Nanoseconds> scale_stamp_;  ///< of the scan that it last followed
  double scale_ = 1.0;
  Pose X_MR_;
  Pose X_OR_;                               ///< what update() was given last
  std::optional<Eigen::Quaterniond> q_OM_;  ///< of the first scan, where M starts: gives the vertical in M
  bool is_keyframe_ = false;
};

}  // namespace plumbline::slam
