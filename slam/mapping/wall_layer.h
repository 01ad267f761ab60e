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

/// How a seen plane is held against a known one. mahalanobis: by both covariances, and side, stretch and storey;
/// angles: as printed in the papers, by the norm of (azimuth, elevation, offset) within an axis class.
enum class Association { mahalanobis, angles };

struct WallLayerConfig {
  Association association = Association::mahalanobis;
  double gate_chi2 = 16.27;    ///< squared Mahalanobis distance, 3 dof, 99.9 %
  double drift_m = 0.03;       ///< sigma of the robot's position against a plane seen just now ...
  double drift_per_m = 0.005;  ///< ... plus this per metre walked since it was seen
  double drift_rad = 0.006;    ///< the same for its attitude
  double drift_rad_per_m = 0.0005;
  double apart_chi2 = 9.0;        ///< of two patches of one scan that are then two faces, 1 dof: no drift between them
  double max_gap_m = 1.0;         ///< between an observation and the known stretch of its wall
  double angles_gate = 0.35;      ///< of the papers' association, rad and m alike [facts: slam 2.3] ...
  double angles_gate_few = 0.05;  ///< ... and for planes of at most ...
  int angles_few = 150;           ///< ... so many points
  double information = 0.0;       ///< of every observation, per rad^2 and m^2; 0: from its covariance
  double floor_offset_m = 0.25;   ///< a floor or ceiling this near and ...
  double floor_angle_rad = 0.08;  ///< ... this level is the storey's
  int min_observations = 4;       ///< of a wall that shapes rooms and is reported
  double min_top_m = 1.3;         ///< above the floor up to which a wall must be seen; lower faces are furniture
  double min_length_m = 0.5;      ///< of a wall that is reported
  double duplicate_offset_m = 0.12;   ///< two faces of one side this near ...
  double duplicate_angle_rad = 0.04;  ///< ... and this parallel cannot both be seen
  double duplicate_overlap = 0.5;     ///< of the shorter one's length and height
  double merge_offset_m = 0.06;       ///< duplicates that the graph has pulled this near ...
  double merge_angle_rad = 0.025;     ///< ... become one
  double duplicate_sigma_rad = 0.01;  ///< of the factor between duplicates
  double duplicate_sigma_m = 0.02;
  double room_drift = 3.0;     ///< times the drift per metre between two vertices of one wall of a room seen again: all
                               ///< its walls agree, where one alone may be mistaken
  double room_offset_m = 0.5;  ///< between such vertices, at most [facts: slam 2.3]

  template <class V>
  void visit(V& v) {
    v("association", association, Field{.doc = "mahalanobis or angles (as printed)"});
    v("gate_chi2", gate_chi2, Field{.doc = "squared Mahalanobis distance of an association", .min = 0});
    v("drift_m", drift_m, Field{.doc = "sigma of the position against a plane just seen", .min = 0});
    v("drift_per_m", drift_per_m, Field{.doc = "growth per metre since the plane was seen", .min = 0});
    v("drift_rad", drift_rad, Field{.doc = "sigma of the attitude against a plane just seen", .min = 0});
    v("drift_rad_per_m", drift_rad_per_m, Field{.doc = "growth per metre since the plane was seen", .min = 0});
    v("apart_chi2", apart_chi2, Field{.doc = "offset of two patches of one scan that are two faces", .min = 0});
    v("max_gap_m", max_gap_m, Field{.doc = "along a wall between what is known and what is seen", .min = 0});
    v("angles_gate", angles_gate, Field{.doc = "of association by angles, rad and m alike", .min = 0});
    v("angles_gate_few", angles_gate_few, Field{.doc = "the same for planes of few points", .min = 0});
    v("angles_few", angles_few, Field{.doc = "points of those", .min = 0});
    v("information", information, Field{.doc = "of a plane observation; 0: from its covariance", .min = 0});
    v("floor_offset_m", floor_offset_m, Field{.doc = "of a floor observation to its storey's floor", .min = 0});
    v("floor_angle_rad", floor_angle_rad, Field{.doc = "of a floor observation to its storey's floor", .min = 0});
    v("min_observations", min_observations, Field{.doc = "of a wall that counts", .min = 1});
    v("min_top_m", min_top_m, Field{.doc = "of a wall above the floor", .min = 0});
    v("min_length_m", min_length_m, Field{.doc = "of a wall that counts", .min = 0});
    v("duplicate_offset_m", duplicate_offset_m, Field{.doc = "between two vertices of one face", .min = 0});
    v("duplicate_angle_rad", duplicate_angle_rad, Field{.doc = "between two vertices of one face", .min = 0});
    v("duplicate_overlap", duplicate_overlap, Field{.doc = "of two vertices of one face", .min = 0, .max = 1});
    v("merge_offset_m", merge_offset_m, Field{.doc = "at which duplicates become one", .min = 0});
    v("merge_angle_rad", merge_angle_rad, Field{.doc = "at which duplicates become one", .min = 0});
    v("duplicate_sigma_rad", duplicate_sigma_rad, Field{.doc = "of the factor between duplicates", .min = 1e-5});
    v("duplicate_sigma_m", duplicate_sigma_m, Field{.doc = "of the factor between duplicates", .min = 1e-5});
    v("room_drift", room_drift, Field{.doc = "times the drift per metre for walls of a room seen again", .min = 0});
    v("room_offset_m", room_offset_m, Field{.doc = "between two vertices of one wall of a room; 0: none", .min = 0});
  }
};

/// The wall layer of a graph [S-Graphs+ section IV-B]: data association, extents and duplicates. It owns the extent of
/// every observation; plane vertices and factors live in the graph.
class WallLayer {
 public:
  explicit WallLayer(const WallLayerConfig& config) : config_(config) {}

  /// Ties the planes seen from the newest keyframe to the graph: a known plane of the same kind, side and storey within
  /// the gate (best fit first, ties: earlier observation, lower id) or a new vertex. Two patches of one scan that are
  /// not coplanar, as a door leaf and its wall, never share a plane, however far the robot may have drifted. walked_m:
  /// length of the way so far. Returns the plane ids.
  std::vector<int> observe(Graph& graph, std::span<const PlaneObservation> seen, double walked_m);

  /// Every plane vertex with the union of its observations' extents; index = id. Merged planes have 0 observations.
  [[nodiscard]] std::vector<PlaneNode> extents(const Graph& graph) const;
  /// Sums up what keyframes before `first` saw, which must then stay where they are and keep their planes until
  /// unsettle(): so that extents() looks at later observations only.
  void settle(const Graph& graph, int first);
  void unsettle();

  /// The walls seen from the newest keyframe, each as far as this keyframe saw it.
  [[nodiscard]] std::vector<PlaneNode> seen_now(const Graph& graph) const;
  /// The walls of a storey that count: seen often, long and high enough.
  [[nodiscard]] std::vector<PlaneNode> walls(const Graph& graph, int storey) const;

  /// Adds a duplicate factor for each pair of one face that has none yet; true when one was added.
  bool find_duplicates(Graph& graph, int storey) const;
  /// Squared Mahalanobis distance over the gate's of two vertices that may be one wall of a room seen again; above 1:
  /// two walls. The covariance is the drift between the last look at the one and the first at the other, which must be
  /// later; walls that do not stand on one side and stretch, or that one scan showed as two faces, are two. `walls`: of
  /// a storey, by id.
  [[nodiscard]] double room_misfit(std::span<const PlaneNode> walls, int a, int b) const;
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
  void note_apart(std::span<const PlaneObservation> seen, std::span<const int> ids);
  [[nodiscard]] bool known_apart(int a, int b) const;
  /// False where there is such a factor already.
  bool add_duplicate(Graph& graph, const PlaneNode& a, const PlaneNode& b) const;
  /// Squared distance of an observation to a known plane over the gate's; above 1: another plane.
  [[nodiscard]] double misfit(const Graph& graph, const PlaneNode& known, const PlaneObservation& seen,
                              double walked_m) const;
  [[nodiscard]] double misfit_as_printed(const Graph& graph, const PlaneNode& known,
                                         const PlaneObservation& seen) const;

  /// What settled observations saw of one plane.
  struct Extent {
    Eigen::Vector2d low_M, high_M;  ///< its ends along the wall
    double z0 = 0.0, z1 = 0.0;
    int observations = 0;
  };

  WallLayerConfig config_;
  std::vector<Patch> patches_;
  std::vector<Extent> settled_;               ///< index = plane id; may be shorter than the planes
  std::size_t settled_factors_ = 0;           ///< plane factors summed up in them
  std::vector<double> first_seen_m_;          ///< way walked when a plane was first seen; index = plane id
  std::vector<double> last_seen_m_;           ///< the same when it was last seen
  std::map<std::pair<int, int>, int> apart_;  ///< of planes, lower id first: scans that showed them as two faces, less
                                              ///< those that showed them as one
  std::set<std::pair<int, int>> far_apart_;   ///< the same for planes too far apart to be duplicates by themselves
};

}  // namespace plumbline::slam

namespace plumbline {

template <>
struct EnumNames<slam::Association> {
  static constexpr std::array<std::string_view, 2> names = {"mahalanobis", "angles"};
};

}  // namespace plumbline
