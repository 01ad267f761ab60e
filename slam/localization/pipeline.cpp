// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/pipeline.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "bim/digest/digest.h"
#include "slam/localization/alternatives.h"
#include "slam/localization/associate.h"
#include "slam/localization/observed_walls.h"
#include "slam/localization/wall_crossing.h"
#include "slam/localization/wall_matches.h"
#include "slam/plan_method/plan_localization.h"

namespace plumbline::slam {

namespace {

/// A gait changes the sensor's height by 3 cm. A floor that is nearer than this is wrong by no more.
constexpr double other_floor_m = 0.1;

/// How far below the floor that the calibration lets expect the robot's own may lie. From a landing the floor of the
/// storey is seen; a LiDAR under a ceiling is no higher above its floor than that.
double floor_tolerance_m(const bim::Plan& plan, const PlanIndex& index, const Calibration& calibration) {
  const bool at_several_levels = std::any_of(index.storeys.begin(), index.storeys.end(),
                                             [](const StoreyIndex& storey) { return storey.floors.has_value(); });
  if (at_several_levels) return other_floor_m;
  double highest_m = 0.0;
  for (const bim::PlanStorey& storey : plan.storeys) highest_m = std::max(highest_m, storey.height_m);
  return std::max(highest_m - calibration.sensor_height_m, other_floor_m);
}

bool has_room(const bim::Plan& plan, int storey) {
  return std::any_of(plan.rooms.begin(), plan.rooms.end(),
                     [&](const bim::PlanRoom& room) { return room.storey == storey; });
}

std::uint64_t digest_of(const LocalizationScan& scan) {
  Digest digest;
  digest.add(scan.X_OR).add(scan.sensor_height);
  for (const Beam& beam : scan.beams) digest.add(beam.direction_H).add(beam.range).add(beam.slope);
  for (const BeamGridBlock& block : scan.beam_grid.blocks)
    for (std::size_t k = 0; k < 4; ++k) digest.add(static_cast<double>(block.range[k]));
  for (const WallObservation& wall : scan.walls) digest.add(wall.azimuth).add(wall.distance).add(wall.s0).add(wall.s1);
  return digest.value();
}

PlanMethodConfig plan_config(const LocalizationConfig& config) {
  return {config, config.search.convergence.yaw_drift, config.index, config.update_s, true, true};
}

class SGraphLocalization final : public PlanLocalization {
 public:
  SGraphLocalization(const MethodInput& input, const LocalizationConfig& config)
      : PlanLocalization("s_graph_localization", input, plan_config(config), config.map),
        config_(config),
        global_localizer_(config.search, input.seed),
        alternatives_(config) {
    config_.scan.max_height_m = wall_height(*input.plan, config.scan);
  }

  [[nodiscard]] Estimate finish() override;

 private:
  void use_scan(const PlanScan& scan, Output& output) override;
  [[nodiscard]] bool follows_standing() const override { return tracker_.has_value(); }
  void use_standing_scan(const PlanScan& scan, Output& output) override;
  [[nodiscard]] bool start_anew() override;
  void report(const Pose& X_OR, Output& output) override;
  /// A scan's walls, and the scan as it is compared with the plan.
  struct Observed {
    std::vector<PlaneObservation> planes;
    LocalizationScan scan;
  };
  [[nodiscard]] Observed observe(const PlanScan& scan, Stopwatch& stopwatch, Output& output);
  void localize(const LocalizationScan& scan, const StartPrior& start_prior,
                const std::vector<PlaneObservation>& planes, Output& output);
  void track(const LocalizationScan& scan, const std::vector<PlaneObservation>& planes, Output& output);
  void start_tracking(const LocalizationScan& scan, const std::vector<PlaneObservation>& planes);
  void follow_storey();
  void check_kidnap(const LocalizationScan& scan);
  enum class Window { holds, is_refuted };  ///< the tracked poses
  void search_anew(Window window);
  [[nodiscard]] bool may_be_carried_elsewhere(double silence_s, const LocalizationScan& scan);
  [[nodiscard]] bool may_be_on_another_storey() const;
  void add_all_storeys();
  [[nodiscard]] bool is_on_floor() const;
  [[nodiscard]] StoreyPose tracked_pose(const LocalizationScan& scan) const;
  void correct_by_beams(const LocalizationScan& scan);
  [[nodiscard]] StartPrior start_prior(const PlanScan& scan) const;
  [[nodiscard]] Pose pose_in_I(const PoseHypothesis& hypothesis, const LocalizationScan& scan) const;
  [[nodiscard]] std::vector<std::vector<WallMatch>> match_walls(const LocalizationScan& scan,
                                                                const std::vector<PlaneObservation>& planes) const;
  [[nodiscard]] std::vector<Hypothesis> hypotheses(const Pose2& u, const Pose& X_OR) const;
  void record_tracked_poses(const std::vector<TrackedPose>& poses);

  LocalizationConfig config_;
  GlobalLocalizer global_localizer_;
  std::optional<PlanTracker> tracker_;
  State state_ = State::searching;
  double mass_ = 0.0;  ///< of the tracked hypothesis when it was announced
  int failed_updates_ = 0;
  std::optional<Nanoseconds> used_stamp_;  ///< of the last scan of a robot that moves
  /// Walked since it stood or was silent for as long as a lift takes, m.
  double since_stop_m_ = std::numeric_limits<double>::infinity();
  bool doubts_place_ = false;               ///< since a silence, until a scan fits: the robot may have been carried
  double misfit_ = 0.0;                     ///< of the tracked pose, see KidnapMonitorConfig
  int storey_ = 0;                          ///< of the tracked hypothesis, index into PlanIndex::storeys
  std::optional<ExpectedYaw> doubted_yaw_;  ///< of the present scan: the robot may have been kidnapped and turned
  Alternatives alternatives_;
  RoomExit room_exit_;
  Agreement agreement_;            ///< of the tracked hypothesis, moving average over scans
  std::optional<Pose> X_IO_last_;  ///< of the last tracking, also after it was lost
  ObservedWalls observed_walls_;
  std::vector<std::vector<WallMatch>> walls_;  ///< of each shown hypothesis, until they are reported
};

void SGraphLocalization::use_scan(const PlanScan& scan, Output& output) {
  Stopwatch stopwatch;
  doubted_yaw_.reset();
  doubts_place_ |= scan.silence_s > 0.0;
  const double since_use_s = used_stamp_ ? seconds(scan.deskewed.stamp - *used_stamp_) : 0.0;
  used_stamp_ = scan.deskewed.stamp;
  const bool stopped = scan.silence_s > 0.0 || since_use_s > config_.monitor.lift_s;
  since_stop_m_ = stopped ? 0.0 : since_stop_m_ + scan.u.t.norm();
  if (stopped && state_ == State::lost) add_all_storeys();
  if (scan.prior_yaw_I) doubted_yaw_ = ExpectedYaw{*scan.prior_yaw_I, scan.prior_yaw_sigma};
  const auto [planes, localization_scan] = observe(scan, stopwatch, output);
  if (!tracker_)
    localize(localization_scan, start_prior(scan), planes, output);  // particles to X_WO [shaheer2023, eq. 4-10]
  else if (may_be_carried_elsewhere(scan.silence_s, localization_scan))
    search_anew(Window::holds);
  else
    track(localization_scan, planes, output);  // S-Graph on the plan's walls and rooms [shaheer2023, section 3.4]
  walls_ = match_walls(localization_scan, planes);
}

SGraphLocalization::Observed SGraphLocalization::observe(const PlanScan& scan, Stopwatch& stopwatch, Output& output) {
  Observed observed;
  observed.planes = observe_planes(scan.deskewed, config_.planes, config_.ransac_without_rings,
                                   input().seed);  // [shaheer2023, eq. 3]
  observed.scan = make_localization_scan(scan.deskewed, observed.planes, scan.X_OR, input().calibration, config_.scan,
                                         floor_tolerance_m(*input().plan, index(), input().calibration));
  observed.scan.tilt_sigma = scan.tilt_sigma;
  record_stage("planes", stopwatch, output);
  output.digests.push_back({"planes", digest_of(observed.scan)});
  return observed;
}

/// Scans from one place are not independent: they correct the tracked pose, and judge nothing.
void SGraphLocalization::use_standing_scan(const PlanScan& scan, Output& output) {
  Stopwatch stopwatch;
  const auto [planes, localization_scan] = observe(scan, stopwatch, output);
  if (const std::optional<TrackedPose> replaced = tracker_->update_standing(localization_scan, planes))
    add_correction(replaced->stamp, replaced->X_IR * replaced->X_OR.inverse());
  correct_by_beams(localization_scan);
  X_IO_last_ = tracker_->X_IO();
  output.digests.push_back({"tracking", Digest().add(tracker_->pose(scan.X_OR)).value()});
  record_stage("tracking", stopwatch, output);
  walls_ = match_walls(localization_scan, planes);
}

void SGraphLocalization::localize(const LocalizationScan& scan, const StartPrior& start_prior,
                                  const std::vector<PlaneObservation>& planes, Output& output) {
  Stopwatch stopwatch;
  for (const StageDigest& digest : global_localizer_.update(index(), start_prior, scan))
    output.digests.push_back(digest);
  // A lost robot stays lost until it has converged again.
  if (state_ != State::lost || global_localizer_.state() == State::converged) state_ = global_localizer_.state();
  record_stage("search", stopwatch, output);
  if (global_localizer_.state() == State::converged) start_tracking(scan, planes);
}

void SGraphLocalization::start_tracking(const LocalizationScan& scan, const std::vector<PlaneObservation>& planes) {
  const PoseHypothesis& best = global_localizer_.hypotheses().front();
  mass_ = best.mass;
  failed_updates_ = 0;
  doubts_place_ = false;
  misfit_ = 0.0;
  storey_ = best.storey;
  alternatives_.clear();
  room_exit_.clear();
  // Of a recording whose owner did not say how high the LiDAR is, the floor tells.
  const double calibrated = input().calibration.sensor_height_m;
  const bool is_calibrated = std::abs(scan.sensor_height - calibrated) < 0.5 * config_.monitor.off_floor_m;
  tracker_.emplace(config_.tracker, index().storeys[static_cast<std::size_t>(best.storey)],
                   (is_calibrated ? calibrated : scan.sensor_height) - input().calibration.X_RL.t.z());
  tracker_->start(scan, planes, pose_in_I(best, scan), best.covariance.topLeftCorner<2, 2>());
  agreement_ = best.agreement;
  X_IO_last_ = tracker_->X_IO();
}

void SGraphLocalization::track(const LocalizationScan& scan, const std::vector<PlaneObservation>& planes,
                               Output& output) {
  Stopwatch stopwatch;
  record_tracked_poses(tracker_->update(scan, planes));
  correct_by_beams(scan);
  X_IO_last_ = tracker_->X_IO();
  output.digests.push_back({"tracking", Digest().add(tracker_->pose(scan.X_OR)).value()});
  record_stage("tracking", stopwatch, output);
  follow_storey();
  if (is_on_floor()) check_kidnap(scan);
  record_stage("monitor", stopwatch, output);
}

/// Along a corridor walls hold nothing, and the few beams that end at the faces across it are no planes.
void SGraphLocalization::correct_by_beams(const LocalizationScan& scan) {
  const std::optional<Eigen::Vector2d> along = tracker_->open_direction();
  if (!along || !is_on_floor()) return;
  RefineConfig config = config_.search.refine;
  config.first_gate_m = config.tracking_gate_m;
  const Pose2 X_IH = heading(tracker_->pose(scan.X_OR));
  const Refined refined = refine(tracker_->storey(), X_IH, scan, config_.search.likelihood, config);
  const double prior = 1.0 / (config.prior_sigma_m * config.prior_sigma_m);
  const double information = 1.0 / along->dot(refined.covariance.topLeftCorner<2, 2>() * *along);
  const double measured = information - prior;
  if (measured < 0.01 * prior) return;
  // Gauss-Newton's step is held back by its prior.
  tracker_->correct_along(*along, along->dot(refined.X_IH.t - X_IH.t) * information / measured, 1.0 / measured);
}

StoreyPose SGraphLocalization::tracked_pose(const LocalizationScan& scan) const {
  return {storey_, heading(tracker_->pose(scan.X_OR)), true};
}

bool SGraphLocalization::is_on_floor() const {
  return std::abs(tracker_->height_over_floor()) < config_.monitor.off_floor_m;
}

/// Changes to the storey whose floor the robot has reached by a stair.
void SGraphLocalization::follow_storey() {
  if (is_on_floor()) return;
  // The plan is compared at the height of a floor, and a history with a gap leads elsewhere.
  failed_updates_ = 0;
  misfit_ = 0.0;
  alternatives_.clear();
  room_exit_.clear();
  const bim::Plan& plan = *input().plan;
  const double z_W = tracker_->feet_z() + index().X_WI.t.z();
  const Eigen::Vector2d p_W = (index().X_WI * tracker_->window().back().X_IR.t).head<2>();
  for (int i = 0; i < static_cast<int>(plan.storeys.size()); ++i) {
    const bim::PlanStorey& storey = plan.storeys[static_cast<std::size_t>(i)];
    const double floor_W = storey.floors ? bim::height_at(*storey.floors, p_W) : storey.elevation_m;
    if (i == tracker_->storey().plan_storey || !has_room(plan, i) ||
        std::abs(z_W - floor_W) >= config_.monitor.off_floor_m)
      continue;
    storey_ = storey_of_plan(i);
    tracker_->change_storey(index().storeys[static_cast<std::size_t>(storey_)]);
    return;
  }
}

/// Withdraws a convergence when the scans no longer fit the plan there.
void SGraphLocalization::check_kidnap(const LocalizationScan& scan) {
  const Pose2 X_IH = heading(tracker_->pose(scan.X_OR));
  const Agreement fit = agreement(tracker_->storey(), X_IH, scan, config_.search.likelihood, config_.search.refine);
  agreement_.update_mean(fit, config_.search.hypotheses.ema_alpha);
  failed_updates_ =
      fit.penetration_ratio_otherwise() > config_.monitor.lost_penetration_ratio ? failed_updates_ + 1 : 0;
  misfit_ = std::max(0.0, misfit_ - config_.search.hypotheses.fit.of_scan(fit));
  const int lost_updates = doubts_place_ ? 1 : config_.monitor.lost_updates;
  const bool has_left =
      room_exit_.update(tracker_->storey(), X_IH, index().config.body_height_m) >= config_.monitor.outside_updates;
  const bool misfits = failed_updates_ >= lost_updates || misfit_ >= config_.monitor.misfit || has_left;
  if (fit.inliers >= config_.search.hypotheses.fit.inliers_min) doubts_place_ = false;
  const Pose2 u = heading(X_OR_update()->inverse() * scan.X_OR);
  const bool is_one_better = alternatives_.is_one_better(index(), {tracked_pose(scan), agreement_}, {u, scan},
                                                         doubted_yaw_, global_localizer_);
  if (!is_one_better && !misfits) return;
  search_anew(Window::is_refuted);
}

/// After a silence in which it may have been carried: whether another place, on any storey, looks the same.
bool SGraphLocalization::may_be_carried_elsewhere(double silence_s, const LocalizationScan& scan) {
  if (silence_s <= config_.monitor.carried_s) return false;
  add_all_storeys();
  return alternatives_.may_stand_elsewhere(index(), tracked_pose(scan), scan, global_localizer_);
}

/// A lift takes its time, or a robot is carried: one that went on walking is on the storey where it was.
bool SGraphLocalization::may_be_on_another_storey() const { return since_stop_m_ < config_.monitor.after_lift_m; }

void SGraphLocalization::add_all_storeys() {
  const bim::Plan& plan = *input().plan;
  for (int i = 0; i < static_cast<int>(plan.storeys.size()); ++i)
    if (has_room(plan, i)) static_cast<void>(storey_of_plan(i));
}

void SGraphLocalization::search_anew(Window window) {
  if (tracker_ && window == Window::holds) record_tracked_poses({tracker_->window().begin(), tracker_->window().end()});
  tracker_.reset();
  global_localizer_.restart();
  state_ = State::lost;
  if (may_be_on_another_storey()) add_all_storeys();
}

void SGraphLocalization::record_tracked_poses(const std::vector<TrackedPose>& poses) {
  for (const TrackedPose& pose : poses) {
    add_correction(pose.stamp, pose.X_IR * pose.X_OR.inverse());
    observed_walls_.add(tracker_->storey(), pose);
  }
}

/// Never a confident pose where nothing measures the robot's way.
bool SGraphLocalization::start_anew() {
  if (tracker_ || state_ == State::lost) {
    search_anew(Window::holds);
  } else {
    global_localizer_.restart();
    state_ = State::searching;
  }
  return true;
}

/// A robot that is lost may have been kidnapped and turned.
StartPrior SGraphLocalization::start_prior(const PlanScan& scan) const {
  if (!scan.prior_yaw_I) return {};
  StartPrior prior;
  if (state_ == State::lost) {
    prior.doubted_yaw = doubted_yaw_;
  } else {
    prior.yaw_I = scan.prior_yaw_I;
    prior.yaw_sigma = scan.prior_yaw_sigma;
  }
  return prior;
}

Pose SGraphLocalization::pose_in_I(const PoseHypothesis& hypothesis, const LocalizationScan& scan) const {
  return pose_on_floor(hypothesis.storey, hypothesis.X_IH, scan.q_HR, scan.sensor_height);
}

void SGraphLocalization::report(const Pose& X_OR, Output& output) {
  output.state = state_;
  if (X_IO_last_) output.X_FR = index().X_WI * (*X_IO_last_ * X_OR);  // [shaheer2023, eq. 10]
  if (tracker_) {
    output.hypotheses.push_back(
        hypothesis_in_W(mass_, storey_, tracker_->pose(X_OR), tracker_->covariance() + end_of_sweep_covariance()));
  } else {
    const Pose2 u = X_OR_update() ? heading(*X_OR_update()).inverse() * heading(X_OR) : Pose2{};
    output.hypotheses = hypotheses(u, X_OR);
    report_particles(global_localizer_.particles(), u, output);
  }
  for (std::size_t i = 0; i < walls_.size(); ++i) output.hypotheses[i].walls = std::move(walls_[i]);
  walls_.clear();
}

std::vector<Hypothesis> SGraphLocalization::hypotheses(const Pose2& u, const Pose& X_OR) const {
  std::vector<Hypothesis> reported;
  for (const PoseHypothesis& hypothesis : global_localizer_.hypotheses()) {
    if (!is_shown(hypothesis.mass)) continue;
    const Pose2 X_IH = hypothesis.X_IH * u;
    const double floor_z = index().storeys[static_cast<std::size_t>(hypothesis.storey)].floor_at(X_IH.t);
    const double height = input().calibration.sensor_height_m - input().calibration.X_RL.t.z();
    const Pose X_level = Pose::from_xyz_yaw({X_IH.t.x(), X_IH.t.y(), floor_z + height}, X_IH.yaw);
    const Eigen::Quaterniond q_HR = exp_so3({0.0, 0.0, -X_OR.yaw()}) * X_OR.q;
    reported.push_back(hypothesis_in_W(hypothesis.mass, hypothesis.storey,
                                       X_level * Pose{q_HR, Eigen::Vector3d::Zero()},
                                       hypothesis.covariance + end_of_sweep_covariance()));
  }
  return reported;
}

/// The scan's walls as associated at each hypothesis.
std::vector<std::vector<WallMatch>> SGraphLocalization::match_walls(const LocalizationScan& scan,
                                                                    const std::vector<PlaneObservation>& planes) const {
  if (tracker_) return {wall_matches(*input().plan, tracker_->storey(), tracker_->window().back().walls)};
  std::vector<std::vector<WallMatch>> walls;
  for (const PoseHypothesis& hypothesis : global_localizer_.hypotheses()) {
    if (!is_shown(hypothesis.mass)) continue;
    const StoreyIndex& storey = index().storeys[static_cast<std::size_t>(hypothesis.storey)];
    const Pose X_IR = pose_in_I(hypothesis, scan);
    walls.push_back(wall_matches(
        *input().plan, storey,
        associate_walls(storey, scan, planes, X_IR, hypothesis.covariance.topLeftCorner<2, 2>(), config_.tracker)));
  }
  return walls;
}

Estimate SGraphLocalization::finish() {
  if (tracker_) record_tracked_poses({tracker_->window().begin(), tracker_->window().end()});
  Estimate estimate = PlanLocalization::finish();
  estimate.planes = observed_walls_.planes(index().X_WI);
  estimate.rooms = observed_walls_.rooms(index().X_WI);
  return estimate;
}

}  // namespace

std::unique_ptr<Method> make_s_graph_localization(const MethodInput& input, const LocalizationConfig& config) {
  return std::make_unique<SGraphLocalization>(input, config);
}

}  // namespace plumbline::slam
