// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <set>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "bim/config/visit.h"
#include "slam/graph/graph.h"
#include "slam/mapping/same_walls.h"
#include "slam/planes/plane_detector.h"

namespace plumbline::slam {

/// How an observed plane is compared with a known one. mahalanobis: by both covariances, and side, stretch and storey;
/// angles: as printed in the papers, by the norm of (azimuth, elevation, offset) within an axis class.
enum class Association { mahalanobis, angles };
[[nodiscard]] constexpr std::array<std::string_view, 2> names_of(Association) { return {"mahalanobis", "angles"}; }

struct WallLayerConfig {
  Association association = Association::mahalanobis;
  double gate_chi2 = 16.27;
  double drift_m = 0.03;
  double drift_per_m = 0.005;
  double drift_rad = 0.006;
  double drift_rad_per_m = 0.0005;
  double separate_faces_chi2 = 9.0;
  double max_gap_m = 1.0;
  double angles_gate = 0.35;
  double angles_gate_few = 0.05;
  int angles_few = 150;
  double information = 0.0;
  double floor_offset_m = 0.25;
  double floor_angle_rad = 0.08;
  int min_observations = 4;
  double min_top_m = 1.3;
  double min_length_m = 0.5;
  double duplicate_offset_m = 0.12;
  double duplicate_angle_rad = 0.04;
  double duplicate_overlap = 0.5;
  double merge_offset_m = 0.06;
  double merge_angle_rad = 0.025;
  double duplicate_sigma_rad = 0.01;
  double duplicate_sigma_m = 0.02;
  double room_drift = 3.0;
  double room_offset_m = 0.5;

  template <class V>
  void visit(V& v) {
    v("association", association,
      Field{.doc = "gate of plane association: Mahalanobis distance, or angles and offset as published"});
    // 3 degrees of freedom, 99.9 %.
    v("gate_chi2", gate_chi2, plain_field("largest squared Mahalanobis distance of an association", {.min = 0}));
    v("drift_m", drift_m,
      Field{.doc = "standard deviation of the robot's position against a plane just seen", .min = 0});
    v("drift_per_m", drift_per_m,
      Field{.doc = "growth of this standard deviation per metre walked since the plane was seen",
            .unit = "m/m",
            .min = 0});
    v("drift_rad", drift_rad,
      Field{.doc = "standard deviation of the robot's attitude against a plane just seen", .min = 0});
    v("drift_rad_per_m", drift_rad_per_m,
      Field{.doc = "growth of this standard deviation per metre walked since the plane was seen",
            .unit = "rad/m",
            .min = 0});
    // 1 degree of freedom: no drift between them.
    v("separate_faces_chi2", separate_faces_chi2,
      plain_field("χ² of the offset of two patches of one scan above which they are two faces",
                  {.min = 0, .former = "apart_chi2"}));
    v("max_gap_m", max_gap_m,
      Field{.doc = "largest gap along a wall between its known stretch and an observation", .min = 0});
    // [lsg2022], as the next two.
    v("angles_gate", angles_gate,
      Field{
          .doc = "gate of association by angles, the same number for angles and offsets", .unit = "rad, m", .min = 0});
    v("angles_gate_few", angles_gate_few,
      Field{.doc = "this gate for planes of few points", .unit = "rad, m", .min = 0});
    v("angles_few", angles_few, Field{.doc = "most points of such a plane", .min = 0});
    v("information", information,
      Field{.doc = "information of each plane observation; 0: from its covariance", .unit = "1/rad², 1/m²", .min = 0});
    v("floor_offset_m", floor_offset_m,
      Field{.doc = "largest offset of a floor or ceiling observation from its storey's", .min = 0});
    v("floor_angle_rad", floor_angle_rad,
      Field{.doc = "largest angle of a floor or ceiling observation to its storey's", .min = 0});
    v("min_observations", min_observations,
      Field{.doc = "least observations of a wall that shapes rooms and is reported", .min = 1});
    v("min_top_m", min_top_m,
      Field{.doc = "least height above the floor to which a wall is seen; lower faces are furniture", .min = 0});
    v("min_length_m", min_length_m, Field{.doc = "least length of a wall that is reported", .min = 0});
    v("duplicate_offset_m", duplicate_offset_m,
      Field{.doc = "largest offset of two faces on one side of a wall that are duplicates", .min = 0});
    v("duplicate_angle_rad", duplicate_angle_rad,
      Field{.doc = "largest angle between two faces that are duplicates", .min = 0});
    v("duplicate_overlap", duplicate_overlap,
      share_field("least overlap of duplicates in length and height, as a share of the shorter"));
    v("merge_offset_m", merge_offset_m,
      Field{.doc = "offset below which duplicates merge, after the graph has pulled them together", .min = 0});
    v("merge_angle_rad", merge_angle_rad, Field{.doc = "angle below which duplicates merge", .min = 0});
    v("duplicate_sigma_rad", duplicate_sigma_rad,
      Field{.doc = "standard deviation of the direction in the factor between duplicates", .min = 1e-5});
    v("duplicate_sigma_m", duplicate_sigma_m,
      Field{.doc = "standard deviation of the offset in the factor between duplicates", .min = 1e-5});
    // All its walls agree, where one alone may be mistaken.
    v("room_drift", room_drift,
      plain_field("factor on the drift per metre for the walls of a room seen again", {.min = 0}));
    // [lsg2022]
    v("room_offset_m", room_offset_m,
      Field{.doc = "largest offset between two vertices of one wall of a room; 0: none merge", .min = 0});
  }
};

/// The wall layer of a graph [bavle2023, section IV-B]: data association, extents and duplicates. It owns the extent of
/// every observation; plane vertices and factors live in the graph.
class WallLayer {
 public:
  explicit WallLayer(const WallLayerConfig& config) : config_(config) {}

  /// Ties the planes seen from the newest keyframe to the graph: a known plane of the same kind, side and storey within
  /// the gate (best fit first, ties: earlier observation, lower id) or a new vertex. Two patches of one scan that are
  /// not coplanar, as a door leaf and its wall, never share a plane, however far the robot may have drifted. walked_m:
  /// distance walked so far. Returns the plane ids.
  std::vector<int> observe(Graph& graph, std::span<const PlaneObservation> seen, double walked_m);

  /// The floors of a storey seen from keyframe `first` on are no common plane: their factors weigh nothing but for the
  /// first of each plane, which then moves nothing, and later floors are other planes. Solve the storey next.
  static void release_floors(Graph& graph, int storey, int first);

  /// Every plane vertex with the union of its observations' extents; index = id. Merged planes have 0 observations.
  [[nodiscard]] std::vector<PlaneNode> extents(const Graph& graph) const;
  /// Sums up what keyframes before `first` saw, which must then stay where they are and keep their planes until
  /// unfreeze_extents(): so that extents() processes later observations only.
  void freeze_extents(const Graph& graph, int first);
  void unfreeze_extents();

  /// The walls seen from the newest keyframe, each as far as this keyframe saw it.
  [[nodiscard]] std::vector<PlaneNode> seen_now(const Graph& graph) const;
  /// The walls of a storey that count: seen often, long and high enough.
  [[nodiscard]] std::vector<PlaneNode> walls(const Graph& graph, int storey) const;

  /// Adds a duplicate factor for each pair of one face that has none yet; true when one was added.
  bool find_duplicates(Graph& graph, int storey) const;
  /// Squared Mahalanobis distance over the gate's of two vertices that may be one wall of a room seen again; above 1:
  /// two walls. The covariance is the drift between the last observation of the one and the first of the other, which
  /// must be later; walls that do not stand on one side and stretch, or that one scan showed as two faces, are two.
  /// `walls`: of a storey, by id.
  [[nodiscard]] double room_normalized_mahalanobis2(std::span<const PlaneNode> walls, int a, int b) const;
  /// Adds a duplicate factor for each pair of `walls` that has none yet; true when one was added.
  bool add_duplicates(Graph& graph, std::span<const PlaneNode> walls, std::span<const SameWall> pairs) const;
  /// Duplicates that now agree become one vertex, the one with the lower id. Returns how many.
  int merge_duplicates(Graph& graph);

 private:
  /// Extent of one observation; index as in Graph::plane_factors.
  struct Patch {
    Eigen::Vector3d p0_R, p1_R;
    double z0 = 0.0, z1 = 0.0;
  };

  /// The plane of each observation, -1 for a new one.
  [[nodiscard]] std::vector<int> match(const Graph& graph, std::span<const PlaneObservation> seen,
                                       double walked_m) const;
  void record_separations(std::span<const PlaneObservation> seen, std::span<const int> ids);
  [[nodiscard]] bool known_separate(int a, int b) const;
  /// False where there is such a factor already.
  bool add_duplicate(Graph& graph, const PlaneNode& a, const PlaneNode& b) const;
  /// Squared distance of an observation to a known plane over the gate's; above 1: another plane.
  [[nodiscard]] double normalized_mahalanobis2(const Graph& graph, const PlaneNode& known, const PlaneObservation& seen,
                                               double walked_m) const;
  [[nodiscard]] double paper_normalized_distance2(const Graph& graph, const PlaneNode& known,
                                                  const PlaneObservation& seen) const;

  /// Extent of one plane from frozen observations.
  struct Extent {
    Eigen::Vector2d low_M, high_M;  ///< its ends along the wall
    double z0 = 0.0, z1 = 0.0;
    int observations = 0;
  };

  WallLayerConfig config_;
  std::vector<Patch> patches_;
  std::vector<Extent> frozen_extents_;  ///< index = plane id; may be shorter than the planes
  std::size_t frozen_factors_ = 0;      ///< plane factors summed up in them
  std::vector<double> first_seen_m_;    ///< distance walked when a plane was first seen; index = plane id
  std::vector<double> last_seen_m_;     ///< the same when it was last seen
  std::map<std::pair<int, int>, int> separation_votes_;  ///< of planes, lower id first: scans that showed them as two
                                                         ///< faces, less those that showed them as one
  std::set<std::pair<int, int>> far_separations_;  ///< the same for planes too far apart to be duplicates by themselves
};

}  // namespace plumbline::slam
