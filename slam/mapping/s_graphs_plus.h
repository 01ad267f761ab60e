// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string_view>

#include "bim/config/visit.h"
#include "slam/graph/incremental.h"
#include "slam/io/method.h"
#include "slam/loop/fitness.h"
#include "slam/loop/loop_closure.h"
#include "slam/mapping/floor_layer.h"
#include "slam/mapping/laser_range_calibration.h"
#include "slam/mapping/level_agreement.h"
#include "slam/mapping/mirror_ghosts.h"
#include "slam/mapping/room_layer.h"
#include "slam/mapping/wall_layer.h"
#include "slam/odometry/front_end.h"
#include "slam/planes/observe.h"
#include "slam/scan/map_cloud.h"
#include "slam/scan/motion.h"

namespace plumbline::slam {

/// Parts of the graph that a baseline or an ablation does without.
struct GraphParts {
  bool walls = true;
  bool rooms = true;
  bool floors = true;
  bool loops = true;

  template <class V>
  void visit(V& v) {
    v("walls", walls, Field{.doc = "wall planes; without them, only floor planes are kept", .basic = true});
    v("rooms", rooms, Field{.doc = "rooms between walls; needs walls", .basic = true});
    v("floors", floors, Field{.doc = "floor centres and the rooms tied to them; needs rooms", .basic = true});
    v("loops", loops, Field{.doc = "loop closures by scan matching", .basic = true});
  }
};

/// Which planes a keyframe sees: by straight stretches of rings, or by sequential RANSAC as in the papers.
enum class PlaneSource { rings, ransac };
[[nodiscard]] constexpr std::array<std::string_view, 2> names_of(PlaneSource) { return {"rings", "ransac"}; }
/// What odometry and loops weigh: by the registration's covariance, or by the clouds' fitness as in the papers' code.
enum class PoseWeights { registration, fitness };
[[nodiscard]] constexpr std::array<std::string_view, 2> names_of(PoseWeights) { return {"registration", "fitness"}; }

struct SGraphsPlusConfig {
  GraphParts parts;
  PlaneSource plane_source = PlaneSource::rings;
  PoseWeights pose_weights = PoseWeights::registration;
  double keyframe_distance_m = 0.6;
  double keyframe_angle_rad = 0.35;
  double odometry_inflation = 8.0;
  double odometry_sigma_m = 0.006;
  double odometry_sigma_rad = 0.002;
  LidarOdometryConfig odometry;
  /// Twice the lasers' 11 mm: range errors of observations that share a laser are correlated, and the graph treats them
  /// as independent.
  PlaneDetectorConfig planes{.laser_sigma_m = 0.022};
  RansacConfig ransac;
  RinglessRansacConfig ransac_without_rings;
  FitnessConfig fitness;
  WallLayerConfig walls;
  RoomLayerConfig rooms;
  FloorLayerConfig floors;
  LevelAgreementConfig level_agreement;
  LoopConfig loop;
  IncrementalConfig incremental;
  OptimizerConfig optimizer;
  MapCloudConfig map{.spacing_m = 0.14, .min_neighbours = 14};
  int map_points = 30'000'000;  ///< 390 MB
  MirrorGhostConfig mirror_ghosts;
  LaserRangeCalibrationConfig laser_range_calibration;

  template <class V>
  void visit(V& v) {
    v("parts", parts);
    v("plane_source", plane_source, Field{.doc = "plane segmentation: along the rings, or RANSAC as in the papers"});
    v("pose_weights", pose_weights,
      Field{.doc = "information of pose factors: from the registration, or from its fitness as in the papers"});
    v("keyframe_distance_m", keyframe_distance_m,
      Field{.doc = "distance walked after which a keyframe is made", .min = 0.05, .basic = true});
    v("keyframe_angle_rad", keyframe_angle_rad,
      Field{.doc = "or angle turned after which a keyframe is made", .min = 0.02, .basic = true});
    v("odometry_inflation", odometry_inflation,
      plain_field("factor on the registration's covariance: surfels are not independent", {.min = 1}));
    v("odometry_sigma_m", odometry_sigma_m,
      Field{.doc = "standard deviation of the position, added to a step between keyframes", .min = 1e-4});
    v("odometry_sigma_rad", odometry_sigma_rad,
      Field{.doc = "standard deviation of the attitude, added to a step between keyframes", .min = 1e-5});
    v("odometry", odometry);
    v("planes", planes);
    v("ransac", ransac);
    v("ransac_without_rings", ransac_without_rings, Field{.advanced = true});
    v("fitness", fitness);
    v("walls", walls);
    v("rooms", rooms);
    v("floors", floors);
    v("level_agreement", level_agreement);
    v("loop", loop);
    v("incremental", incremental);
    v("optimizer", optimizer);
    v("map", map);
    v("map_points", map_points,
      Field{.doc = "most points of the scans kept for the map; at more, every other scan is dropped and the distance "
                   "between them doubled",
            .min = 1000});
    v("mirror_ghosts", mirror_ghosts, Field{.former = "reflections"});
    v("laser_range_calibration", laser_range_calibration, Field{.former = "range_offsets"});
  }
};

/// S-Graphs+ with the planes, cut, weights and parameters of the papers' code [lsg2022], but rooms of all walls of a
/// storey.
struct SGraphsPlusAllWallsConfig : SGraphsPlusConfig {
  SGraphsPlusAllWallsConfig();
};

/// S-Graphs of 2022: its rooms come from the planes of one keyframe, and there is no floor layer.
struct SGraphsConfig : SGraphsPlusAllWallsConfig {
  SGraphsConfig();
};

/// S-Graphs+ as printed in its rooms, too: clusters of free space with the newest keyframe's own planes, known again by
/// their centres, a factor each look [bavle2023, section IV-C].
struct SGraphsPlusPrintedConfig : SGraphsPlusAllWallsConfig {
  SGraphsPlusPrintedConfig();
};

/// S-Graphs by the rules of 2022 [lsg2022s]: rooms and corridors of one keyframe's planes within windows of length and
/// width, association within 0.2, plane factors of information 1.
struct SGraphs2022Config : SGraphsConfig {
  SGraphs2022Config();
};

/// The same graph without walls, rooms and floor layer: keyframes, our odometry, floor plane and loop closures. Not HDL
/// graph SLAM [koide2019], which is in slam/baselines/hdl_slam_paper.
struct KeyframeGraphConfig : SGraphsPlusConfig {
  KeyframeGraphConfig() { parts = {.walls = false, .rooms = false, .floors = false, .loops = true}; }
};

/// S-Graphs+ [bavle2023, Fig. 2]: odometry, walls, free-space rooms, floors and loops in one four-layered graph.
class SGraphsPlus : public Method {
 public:
  SGraphsPlus(const MethodInput& input, const SGraphsPlusConfig& config);

  void on_odometry(const Odometry& odometry) override { front_end_.on_odometry(odometry); }
  [[nodiscard]] Output on_scan(const Scan& scan) override;
  [[nodiscard]] Estimate finish() override;

  [[nodiscard]] const Graph& graph() const { return graph_; }

 private:
  /// One scan's odometry, and the last keyframe before it.
  struct TrackedScan {
    Nanoseconds stamp = 0;
    int keyframe = 0;
    Pose X_OR;
  };

  void account_for_dead_reckoning(const Registration& odometry);
  [[nodiscard]] bool is_keyframe(const Pose& X_OR) const;
  void add_keyframe(const DeskewedScan& scan, const Registration& odometry, Output& output);
  [[nodiscard]] std::vector<PlaneObservation> planes_of(const DeskewedScan& scan) const;
  /// Drops from what was seen the planes that are neither walls nor level, or contradict the odometry.
  void add_keyframe_vertex(Nanoseconds stamp, const Registration& odometry, std::vector<PlaneObservation>& seen);
  /// Of a keyframe's step from the last one over `way_m`.
  [[nodiscard]] Matrix6d step_information(const Registration& odometry, double way_m) const;
  [[nodiscard]] bool ties_nothing() const;
  [[nodiscard]] Matrix6d tied_information() const;
  void update_rooms(int storey, std::span<const PlaneNode> walls);
  [[nodiscard]] bool find_duplicates_in_rooms(std::span<const PlaneNode> walls, std::span<const PlaneNode> seen);
  void close_loop(const DeskewedScan& scan);
  void optimize_graph();
  /// Of walls and of the rooms between them; returns how many.
  int merge_duplicates();
  void weigh_by_fitness(PoseFactor& factor) const;
  [[nodiscard]] Pose X_MO(std::size_t keyframe) const;
  [[nodiscard]] std::vector<StampedPose> trajectory() const;
  void keep_cloud(const DeskewedScan& scan);
  [[nodiscard]] std::vector<Eigen::Vector3f> point_map(const Estimate& estimate);

  SGraphsPlusConfig config_;
  std::uint64_t seed_;
  Calibration calibration_;
  FrontEnd front_end_;
  WallLayer walls_;
  RoomLayer rooms_;
  FloorLayer floors_;
  LevelAgreement level_agreement_;
  LoopClosure loop_;
  Graph graph_;
  IncrementalOptimizer back_end_;
  std::vector<SegmentedScan> segmented_;
  std::vector<TrackedScan> scans_;
  std::vector<CloudKeyframe> clouds_;                         ///< of scans at least map.spacing_m apart along the way
  std::vector<std::size_t> cloud_scans_;                      ///< index into scans_ of each cloud
  std::vector<std::vector<Eigen::Vector3d>> fitness_clouds_;  ///< index = keyframe, for PoseWeights::fitness
  std::optional<Vector6d>
      dead_reckoning_variance_;  ///< variances of the dead reckoning since the last keyframe that no scan took back
  bool map_began_ = false;       ///< since the last keyframe
  bool first_began_map_ = true;  ///< the first keyframe; not one of a LiDAR that sees nothing
  bool odometry_valid_ = true;   ///< odometry is continuous since the last keyframe
  std::optional<int> first_displaced_keyframe_;  ///< since when the place of the map is not known
  double walked_m_ = 0.0;
  bool global_solve_requested_ = false;  ///< a loop, a duplicate or a wall from before the prior came in
  bool global_solve_urgent_ = false;     ///< a loop that contradicts the estimate
};

/// All assume constant velocity where there is no odometry.
[[nodiscard]] std::unique_ptr<Method> make_s_graphs_plus_method(const MethodInput& input);
[[nodiscard]] std::unique_ptr<Method> make_s_graphs_plus_all_walls_method(const MethodInput& input);
[[nodiscard]] std::unique_ptr<Method> make_s_graphs_method(const MethodInput& input);
[[nodiscard]] std::unique_ptr<Method> make_s_graphs_plus_printed_method(const MethodInput& input);
[[nodiscard]] std::unique_ptr<Method> make_s_graphs_2022_method(const MethodInput& input);
[[nodiscard]] std::unique_ptr<Method> make_keyframe_graph_method(const MethodInput& input);

}  // namespace plumbline::slam
