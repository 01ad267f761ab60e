// SPDX-License-Identifier: Apache-2.0
#include "slam/mapping/s_graphs_plus.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "bim/digest/digest.h"
#include "slam/graph/factors.h"
#include "slam/graph/graph_json.h"
#include "slam/io/stopwatch.h"
#include "slam/planes/level.h"
#include "slam/planes/segmented_scan.h"

namespace plumbline::slam {

namespace {

RoomLayerConfig with_mount(RoomLayerConfig config, const Calibration& calibration) {
  config.free_space.sensor_height_m = calibration.sensor_height_m;
  return config;
}

std::uint64_t digest_of(std::span<const PlaneObservation> planes) {
  Digest digest;
  for (const PlaneObservation& p : planes) digest.add(p.plane_R).add(p.points).add(p.p0_R).add(p.p1_R);
  return digest.value();
}

std::uint64_t digest_of(std::span<const RoomNode> rooms) {
  Digest digest;
  for (const RoomNode& room : rooms) {
    digest.add(room.id).add(room.center_F);
    for (const int plane : room.planes) digest.add(plane);
    for (const Eigen::Vector2d& p : room.polygon_F) digest.add(p);
  }
  return digest.value();
}

std::uint64_t digest_of(std::span<const int> ids) {
  Digest digest;
  for (const int id : ids) digest.add(id);
  return digest.value();
}

/// Records a stage's digest, and its CPU time since the last one under the name that the papers' tables give it.
void record_stage(Output& output, Stopwatch& stopwatch, const std::string& stage, std::uint64_t digest,
                  const std::string& timed_as) {
  output.times.push_back({timed_as, stopwatch.cpu_ms()});
  output.digests.push_back({stage, digest});
  stopwatch.restart();
}
void record_stage(Output& output, Stopwatch& stopwatch, const std::string& stage, std::uint64_t digest) {
  record_stage(output, stopwatch, stage, digest, stage);
}

std::uint64_t digest_of(const std::vector<FloorVertex>& floors) {
  Digest digest;
  for (const FloorVertex& floor : floors) digest.add(floor.center_M).add(floor.plane);
  return digest.value();
}

std::unique_ptr<Method> make(const MethodInput& input, SGraphsPlusConfig config) {
  config.odometry.vgicp.odometry_prior &= input.has_odometry;
  config.odometry.vgicp.tilt_prior &= input.has_odometry;
  return std::make_unique<SGraphsPlus>(input, config);
}

}  // namespace

SGraphsPlus::SGraphsPlus(const MethodInput& input, const SGraphsPlusConfig& config)
    : config_(config),
      seed_(input.seed),
      calibration_(input.calibration),
      front_end_(config.odometry, input.calibration, input.has_odometry),
      walls_(config.walls),
      rooms_(with_mount(config.rooms, input.calibration)),
      floors_(config.floors),
      level_agreement_(config.level_agreement),
      loop_(config.loop),
      back_end_(config.incremental, config.optimizer) {
  config_.floors.robot_height_m = input.calibration.sensor_height_m - input.calibration.X_RL.t.z();
}

Output SGraphsPlus::on_scan(const Scan& scan) {
  Output output;
  output.stamp = scan.stamp;
  Stopwatch stopwatch;
  DeskewedScan deskewed = front_end_.deskewed(scan);
  record_stage(output, stopwatch, "deskew", digest(deskewed));

  const Registration odometry = front_end_.track(scan, deskewed);
  record_stage(output, stopwatch, "odometry", Digest().add(odometry.X_MR).add(odometry.degenerate_directions).value());

  const Pose& X_OR = odometry.X_MR;
  if (odometry.lost || odometry.displaced) output.state = State::lost;
  if (!odometry.displaced)
    first_displaced_keyframe_.reset();
  else if (!first_displaced_keyframe_)
    first_displaced_keyframe_ = static_cast<int>(graph_.keyframes.size());
  output.degenerate_directions = odometry.degenerate_directions;
  odometry_valid_ &= odometry.odometry_valid;
  if (!graph_.keyframes.empty()) account_for_dead_reckoning(odometry);
  // A scan that does not fit would be mapped at a wrong pose.
  if (graph_.keyframes.empty() || (odometry.accepted && !odometry.lost && is_keyframe(X_OR)))
    add_keyframe(deskewed, odometry, output);
  const auto keyframe = graph_.keyframes.size() - 1;
  scans_.push_back({scan.stamp, static_cast<int>(keyframe), X_OR});
  stopwatch.restart();
  if (odometry.accepted || scans_.size() == 1) keep_cloud(deskewed);
  output.times.push_back({"map", stopwatch.cpu_ms()});
  output.X_FR = X_MO(keyframe) * X_OR;
  return output;
}

// The map that the last keyframe was matched with measures the step to the next one, whatever did not fit meanwhile; a
// map that began since then is placed by dead reckoning.
void SGraphsPlus::account_for_dead_reckoning(const Registration& odometry) {
  map_began_ |= odometry.began;
  if (!odometry.accepted)
    dead_reckoning_variance_ =
        dead_reckoning_variance_.value_or(Vector6d(Vector6d::Zero())) + odometry.information.diagonal().cwiseInverse();
  else if (!map_began_)
    dead_reckoning_variance_.reset();
}

bool SGraphsPlus::is_keyframe(const Pose& X_OR) const {
  if (graph_.keyframes.empty()) return true;
  const Pose step = graph_.keyframes.back().X_OR.inverse() * X_OR;
  return step.t.norm() > config_.keyframe_distance_m || log_so3(step.q).norm() > config_.keyframe_angle_rad;
}

// [bavle2023, Fig. 2]: walls, rooms, floors and loops of one keyframe, then the back end.
void SGraphsPlus::add_keyframe(const DeskewedScan& scan, const Registration& odometry, Output& output) {
  Stopwatch stopwatch;
  std::vector<PlaneObservation> seen = planes_of(scan);
  record_stage(output, stopwatch, "planes", digest_of(seen), "plane_segmentation");
  if (config_.parts.walls && (segmented_.empty() || scan.stamp - segmented_.back().stamp >= segmented_interval))
    segmented_.push_back(segmented_scan(scan, seen));
  // Among vehicles their sides turn as the road does: as walls they would straighten the path.
  if (odometry.moving_R) std::erase_if(seen, [](const PlaneObservation& o) { return o.vertical; });

  add_keyframe_vertex(scan.stamp, odometry, seen);
  if (config_.pose_weights == PoseWeights::fitness) {
    fitness_clouds_.push_back(fitness_cloud(scan, config_.fitness));
    if (graph_.keyframes.size() > 1) weigh_by_fitness(graph_.pose_factors.back());
  }
  const int storey = graph_.keyframes.back().storey;
  record_stage(output, stopwatch, "association", digest_of(walls_.observe(graph_, seen, walked_m_)));

  global_solve_requested_ |= walls_.find_duplicates(graph_, storey);
  if (config_.parts.rooms) rooms_.add_scan(graph_, scan, seen);
  const std::vector<PlaneNode> seen_now = walls_.seen_now(graph_);
  const std::vector<PlaneNode> walls = walls_.walls(graph_, storey);
  if (config_.parts.rooms) global_solve_requested_ |= find_duplicates_in_rooms(walls, seen_now);
  if (config_.parts.rooms) rooms_.add_from_keyframe(graph_, seen_now);
  if (config_.parts.rooms) rooms_.update(graph_, storey, walls);
  record_stage(output, stopwatch, "rooms", digest_of(rooms_.nodes(graph_)), "room_segmentation");
  if (config_.parts.rooms && config_.parts.floors) floors_.update(graph_, storey, walls);
  record_stage(output, stopwatch, "floors", digest_of(graph_.floors), "floor_segmentation");

  if (config_.parts.loops) close_loop(scan);
  record_stage(output, stopwatch, "loop", Digest().add(static_cast<std::int64_t>(graph_.pose_factors.size())).value(),
               "loop_closure");

  optimize_graph();
  record_stage(output, stopwatch, "graph", slam::digest_of(graph_), "back_end");
}

void SGraphsPlus::keep_cloud(const DeskewedScan& scan) {
  const Pose& X_OR = scans_.back().X_OR;
  if (!clouds_.empty() && (scans_[cloud_scans_.back()].X_OR.t - X_OR.t).norm() < config_.map.spacing_m) return;
  clouds_.push_back(thin_rings(scan, X_OR, config_.map));
  cloud_scans_.push_back(scans_.size() - 1);
  if (point_count(clouds_) <= static_cast<std::size_t>(config_.map_points)) return;
  config_.map.spacing_m *= 2.0;
  keep_every_other(clouds_);
  keep_every_other(cloud_scans_);
}

std::vector<PlaneObservation> SGraphsPlus::planes_of(const DeskewedScan& scan) const {
  std::vector<PlaneObservation> seen;
  if (config_.plane_source == PlaneSource::ransac)
    seen = ransac_planes(scan, config_.ransac, config_.planes, seed_);
  else
    seen = observe_planes(scan, config_.planes, config_.ransac_without_rings, seed_);
  if (!config_.parts.walls) std::erase_if(seen, [](const PlaneObservation& o) { return !is_floor(o); });
  return seen;
}

void SGraphsPlus::weigh_by_fitness(PoseFactor& factor) const {
  const auto& from = fitness_clouds_[static_cast<std::size_t>(factor.from)];
  const auto& to = fitness_clouds_[static_cast<std::size_t>(factor.to)];
  if (from.empty() || to.empty()) return;
  factor.information = fitness_information(fitness(from, to, factor.X_FT), config_.fitness);
}

void SGraphsPlus::update_rooms(int storey, std::span<const PlaneNode> walls) {
  if (!config_.parts.rooms) return;
  rooms_.update(graph_, storey, walls);
  if (config_.parts.floors) floors_.update(graph_, storey, walls);
}

// A room seen again shows which walls are one [bavle2023, section IV-C].
bool SGraphsPlus::find_duplicates_in_rooms(std::span<const PlaneNode> walls, std::span<const PlaneNode> seen) {
  const WallDistance distance = [&](int known, int found) {
    return walls_.room_normalized_mahalanobis2(walls, known, found);
  };
  return walls_.add_duplicates(graph_, walls, rooms_.find_revisited_walls(graph_, seen, distance));
}

void SGraphsPlus::add_keyframe_vertex(Nanoseconds stamp, const Registration& odometry,
                                      std::vector<PlaneObservation>& seen) {
  const Pose& X_OR = odometry.X_MR;
  if (graph_.keyframes.empty()) {
    graph_.keyframes.push_back({stamp, Pose{level_by_planes(seen), Eigen::Vector3d::Zero()}, X_OR, 0});
    first_began_map_ = odometry.began;
    level_agreement_.add_step({}, Matrix6d::Zero());
    level_agreement_.drop_contradicted(seen);
    return;
  }
  const KeyframeVertex& last = graph_.keyframes.back();
  const Pose step = last.X_OR.inverse() * X_OR;
  const Pose X_MR = last.X_MR * step;
  const Matrix6d information = ties_nothing() ? tied_information() : step_information(odometry, step.t.norm());
  level_agreement_.add_step(step, information.llt().solve(Matrix6d::Identity()));
  level_agreement_.drop_contradicted(seen);
  if (const std::optional<int> first = level_agreement_.sloping_since()) {
    WallLayer::release_floors(graph_, last.storey, *first);
    global_solve_requested_ = global_solve_urgent_ = true;
  }
  drop_tilted_planes(seen, X_MR, config_.floors);
  const int from = static_cast<int>(graph_.keyframes.size()) - 1;
  walked_m_ += step.t.norm();
  graph_.pose_factors.push_back({from, from + 1, step, information, false});
  dead_reckoning_variance_.reset();
  map_began_ = false;
  odometry_valid_ = true;
  graph_.keyframes.push_back({stamp, X_MR, X_OR, storey_of(graph_, X_MR, seen, config_.floors)});
}

// A first keyframe without planes, as of a LiDAR that is covered, holds nothing but the frame. A step from there that
// is not known would let the whole graph turn about it.
bool SGraphsPlus::ties_nothing() const {
  return graph_.keyframes.size() == 1 && !first_began_map_ && graph_.plane_factors.empty() && dead_reckoning_variance_;
}

Matrix6d SGraphsPlus::tied_information() const {
  const double m = config_.odometry_sigma_m, rad = config_.odometry_sigma_rad;
  const Vector6d sigmas = (Vector6d() << m, m, m, rad, rad, rad).finished();
  return sigmas.cwiseAbs2().cwiseInverse().asDiagonal();
}

// Where surfels do not constrain the motion, as along a corridor, VGICP's step is that of the odometry, with its
// information.
Matrix6d SGraphsPlus::step_information(const Registration& odometry, double way_m) const {
  const LidarOdometryConfig& config = config_.odometry;
  const Matrix6d dead_reckoning = dead_reckoning_information(config, way_m);
  if (config.kind == OdometryKind::legs) return dead_reckoning;
  const Matrix6d seen =
      dead_reckoning_variance_ ? Matrix6d(dead_reckoning_variance_->cwiseInverse().asDiagonal()) : odometry.information;
  const Matrix6d information =
      trusted_information(seen, config_.odometry_inflation, config_.odometry_sigma_m, config_.odometry_sigma_rad);
  const bool with_dead_reckoning =
      config.kind == OdometryKind::vgicp && config.vgicp.odometry_prior && odometry_valid_ && !dead_reckoning_variance_;
  return with_dead_reckoning ? Matrix6d(information + dead_reckoning) : information;
}

void SGraphsPlus::close_loop(const DeskewedScan& scan) {
  const std::optional<PoseFactor> loop = loop_.update(graph_, scan, walked_m_);
  if (!loop) return;
  graph_.pose_factors.push_back(*loop);
  if (config_.pose_weights == PoseWeights::fitness) weigh_by_fitness(graph_.pose_factors.back());
  const PoseFactor& factor = graph_.pose_factors.back();
  if (std::min(factor.from, factor.to) < first_displaced_keyframe_.value_or(0)) front_end_.locate_map();
  const auto X_M = [&](int k) { return graph_.keyframes[static_cast<std::size_t>(k)].X_MR; };
  const Vector6d e = pose_residual(X_M(factor.from), X_M(factor.to), factor.X_FT).e;
  global_solve_requested_ = true;
  global_solve_urgent_ |= e.dot(factor.information * e) > config_.incremental.urgent_chi2;
}

// The window at each keyframe; the storey when something leads back to before it.
void SGraphsPlus::optimize_graph() {
  if (graph_.keyframes.size() < 2) return;
  if (config_.incremental.batch) {
    optimize(graph_, 1, config_.optimizer);
    (void)merge_duplicates();
    return;
  }
  back_end_.update(graph_);
  walls_.freeze_extents(graph_, back_end_.first_keyframe());
  global_solve_requested_ |= back_end_.revisited_marginalized_plane();
  if (!global_solve_urgent_ && !(global_solve_requested_ && back_end_.solve_is_due(graph_))) return;
  // Storeys share no planes, so that what leads back within one leaves those before it as they are.
  const int storey = graph_.keyframes.back().storey;
  const auto first = std::find_if(graph_.keyframes.begin(), graph_.keyframes.end(),
                                  [&](const KeyframeVertex& k) { return k.storey == storey; });
  back_end_.solve(graph_, static_cast<int>(first - graph_.keyframes.begin()));
  walls_.unfreeze_extents();
  global_solve_requested_ = merge_duplicates() > 0;
  global_solve_urgent_ = false;
  back_end_.relinearize(graph_);
}

int SGraphsPlus::merge_duplicates() {
  const int merged = walls_.merge_duplicates(graph_);
  if (merged > 0) rooms_.redirect_merged_planes(graph_);
  return merged;
}

Pose SGraphsPlus::X_MO(std::size_t keyframe) const {
  return graph_.keyframes[keyframe].X_MR * graph_.keyframes[keyframe].X_OR.inverse();
}

Estimate SGraphsPlus::finish() {
  Estimate estimate;
  if (graph_.keyframes.empty()) return estimate;
  if (graph_.keyframes.size() > 1) optimize(graph_, 1, config_.optimizer);
  walls_.unfreeze_extents();
  (void)merge_duplicates();
  if (config_.parts.rooms) rooms_.rebuild_free_space(graph_);
  const int storeys = 1 + std::max_element(graph_.keyframes.begin(), graph_.keyframes.end(), [](auto& a, auto& b) {
                            return a.storey < b.storey;
                          })->storey;
  for (int storey = 0; storey < storeys; ++storey) {
    const std::vector<PlaneNode> walls = walls_.walls(graph_, storey);
    update_rooms(storey, walls);
    estimate.planes.insert(estimate.planes.end(), walls.begin(), walls.end());
  }
  estimate.trajectory = trajectory();
  estimate.rooms = rooms_.nodes(graph_);
  for (const FloorVertex& floor : graph_.floors) {
    if (floor.plane < 0) continue;
    const Plane& plane = graph_.planes[static_cast<std::size_t>(floor.plane)].plane_M;
    const double z = -(plane.d + plane.n.head<2>().dot(floor.center_M)) / plane.n.z();
    estimate.floors.push_back({floor.storey, {floor.center_M.x(), floor.center_M.y(), z}, plane});
  }
  if (config_.parts.loops) estimate.loops = loop_edges(graph_);
  estimate.segmented = segmented_;
  estimate.map_F = point_map(estimate);
  estimate.graph = graph_tree(graph_);
  return estimate;
}

// Between two keyframes the correction changes linearly from the one's to the other's.
std::vector<StampedPose> SGraphsPlus::trajectory() const {
  std::vector<StampedPose> poses;
  for (const TrackedScan& scan : scans_) {
    const auto k = static_cast<std::size_t>(scan.keyframe);
    Pose X_MR = X_MO(k) * scan.X_OR;
    if (k + 1 < graph_.keyframes.size()) {
      const Nanoseconds from = graph_.keyframes[k].stamp, to = graph_.keyframes[k + 1].stamp;
      const double s = to > from ? seconds(scan.stamp - from) / seconds(to - from) : 0.0;
      X_MR = interpolate(X_MR, X_MO(k + 1) * scan.X_OR, s);
    }
    poses.push_back({scan.stamp, X_MR});
  }
  return poses;
}

std::vector<Eigen::Vector3f> SGraphsPlus::point_map(const Estimate& estimate) {
  for (std::size_t k = 0; k < clouds_.size(); ++k) clouds_[k].X_FR = estimate.trajectory[cloud_scans_[k]].X_FR;
  std::vector<Plane> levels_M;
  for (const FloorNode& floor : estimate.floors) levels_M.push_back(floor.plane_F);
  for (const PlaneVertex& plane : graph_.planes)
    if (plane.kind == PlaneKind::ceiling && plane.merged_into < 0) levels_M.push_back(plane.plane_M);
  const Eigen::Vector3d& sensor_R = calibration_.X_RL.t;
  remove_mirror_ghosts(clouds_, estimate.planes, levels_M, sensor_R, config_.mirror_ghosts);
  if (config_.laser_range_calibration.correct)
    correct_ranges(clouds_,
                   calibrate_laser_ranges(clouds_, estimate.planes, sensor_R, config_.laser_range_calibration,
                                          config_.mirror_ghosts),
                   sensor_R);
  return map_cloud(clouds_, config_.map, levels_M);
}

std::unique_ptr<Method> make_s_graphs_plus_method(const MethodInput& input) {
  return make(input, config_of<SGraphsPlusConfig>(input));
}

std::unique_ptr<Method> make_s_graphs_plus_all_walls_method(const MethodInput& input) {
  return make(input, config_of<SGraphsPlusAllWallsConfig>(input));
}

std::unique_ptr<Method> make_s_graphs_method(const MethodInput& input) {
  return make(input, config_of<SGraphsConfig>(input));
}

std::unique_ptr<Method> make_s_graphs_plus_printed_method(const MethodInput& input) {
  return make(input, config_of<SGraphsPlusPrintedConfig>(input));
}

std::unique_ptr<Method> make_s_graphs_2022_method(const MethodInput& input) {
  return make(input, config_of<SGraphs2022Config>(input));
}

std::unique_ptr<Method> make_keyframe_graph_method(const MethodInput& input) {
  return make(input, config_of<KeyframeGraphConfig>(input));
}

}  // namespace plumbline::slam
