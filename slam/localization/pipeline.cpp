// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/pipeline.h"

#include <algorithm>
#include <cmath>

#include "bim/digest/digest.h"
#include "bim/errors.h"
#include "slam/io/stopwatch.h"
#include "slam/localization/associate.h"
#include "slam/localization/observed_walls.h"
#include "slam/localization/wall_matches.h"
#include "slam/plan_method/corrected_trajectory.h"
#include "slam/scan/map_cloud.h"

namespace plumbline::slam {

namespace {

std::uint64_t digest_of(const View& view) {
  Digest digest;
  digest.add(view.X_OR).add(view.sensor_height);
  for (const Beam& beam : view.beams) digest.add(beam.direction_H).add(beam.range).add(beam.slope);
  for (const SweepBlock& block : view.sweep.blocks)
    for (std::size_t k = 0; k < 4; ++k) digest.add(static_cast<double>(block.range[k]));
  for (const WallView& wall : view.walls) digest.add(wall.azimuth).add(wall.distance).add(wall.s0).add(wall.s1);
  return digest.value();
}

/// (x, y, yaw) covariance turned about z.
Eigen::Matrix3d turned(const Eigen::Matrix3d& P, const Pose& X_WI) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() = heading(X_WI).rotation();
  return R * P * R.transpose();
}

HypothesisSet watch_set(const LocalizationConfig& config) {
  HypothesisConfig hypotheses = config.search.hypotheses;
  hypotheses.history = config.watch.views;
  hypotheses.drop_ratio = config.watch.drop_ratio;
  return {hypotheses, config.search.refine, config.search.likelihood, config.search.contest};
}

/// Notes the time since the last stage and starts the next one.
void note(const char* stage, Stopwatch& watch, Output& output) {
  output.times.push_back({stage, watch.cpu_ms()});
  watch.restart();
}

class SGraphLocalization final : public Method {
 public:
  SGraphLocalization(const MethodInput& input, const LocalizationConfig& config)
      : config_(config),
        input_(input),
        index_(make_plan_index(*input.plan, input.prior.storey, config.index)),
        search_(config.search, input.seed),
        watch_(watch_set(config)),
        cloud_(config.map) {}

  void on_odometry(const Odometry& odometry) override { motion_.add(odometry); }
  [[nodiscard]] Output on_scan(const Scan& scan) override;
  [[nodiscard]] Estimate finish() override;

 private:
  void update(const Scan& scan, const Pose& X_OR, Output& output);
  void localize(const View& view, const std::vector<PlaneObservation>& planes, Output& output);
  void track(const View& view, const std::vector<PlaneObservation>& planes, Output& output);
  void start_tracking(const View& view, const std::vector<PlaneObservation>& planes);
  void monitor(const View& view);
  [[nodiscard]] bool is_overtaken(const View& view);
  [[nodiscard]] bool is_tracked(const Candidate& place, const View& view) const;
  [[nodiscard]] bool is_due(const Pose& X_OR) const;
  [[nodiscard]] StartBelief belief(Nanoseconds stamp, const Pose& X_OR) const;
  [[nodiscard]] Pose pose_in_I(const Candidate& candidate, const View& view) const;
  void say_where(const Pose& X_OR, Output& output) const;
  void show_walls(const View& view, const std::vector<PlaneObservation>& planes, Output& output) const;
  void show_particles(const Pose2& u, Output& output) const;
  [[nodiscard]] std::vector<Hypothesis> hypotheses(const Pose2& u, const Pose& X_OR) const;
  void keep(const std::vector<TrackedPose>& poses);

  LocalizationConfig config_;
  MethodInput input_;
  PlanIndex index_;
  MotionBuffer motion_;
  PlanSearch search_;
  std::optional<PlanTracker> tracker_;
  State state_ = State::searching;
  double mass_ = 0.0;  ///< of the place tracked, when it was announced
  int failed_updates_ = 0;
  int storey_ = 0;       ///< of the place tracked, index into PlanIndex::storeys
  HypothesisSet watch_;  ///< of the last way; places only while it looks
  double unwatched_m_ = 0.0;
  Agreement agreement_;  ///< of the place tracked with the last views
  std::optional<Pose> X_OR_start_;
  std::optional<Pose> X_OR_update_;
  std::optional<Pose> X_IO_last_;  ///< of the last tracking, also after it was lost
  Trail trail_;
  SeenWalls seen_;
  MapCloudRecorder cloud_;  ///< in O until the end
  std::vector<Nanoseconds> cloud_stamps_;
};

Output SGraphLocalization::on_scan(const Scan& scan) {
  Output output;
  output.stamp = scan.stamp;
  const Pose X_OR = motion_.at(scan.stamp);
  if (!X_OR_start_) X_OR_start_ = X_OR;
  if (is_due(X_OR))
    update(scan, X_OR, output);
  else
    say_where(X_OR, output);
  trail_.add_scan(scan.stamp, X_OR);
  motion_.forget_before(scan.stamp - 1'000'000'000);
  return output;
}

void SGraphLocalization::update(const Scan& scan, const Pose& X_OR, Output& output) {
  Stopwatch watch;
  const DeskewedScan deskewed = deskew(scan, motion_, input_.calibration);
  if (cloud_.add(deskewed, X_OR)) cloud_stamps_.push_back(scan.stamp);
  note("deskew", watch, output);
  const std::vector<PlaneObservation> planes = detect_planes(deskewed, config_.planes);  // [BIM-Loc eq. 3]
  const View view = make_view(deskewed, planes, X_OR, input_.calibration, config_.view);
  note("planes", watch, output);
  output.digests.push_back({"planes", digest_of(view)});
  if (!tracker_)
    localize(view, planes, output);  // particles to X_WO [BIM-Loc eq. 4-10]
  else
    track(view, planes, output);  // S-Graph on the plan's walls and rooms [BIM-Loc section 3.4]
  X_OR_update_ = X_OR;
  say_where(X_OR, output);
  show_walls(view, planes, output);
}

void SGraphLocalization::localize(const View& view, const std::vector<PlaneObservation>& planes, Output& output) {
  Stopwatch watch;
  for (const StageDigest& digest : search_.update(index_, belief(view.stamp, view.X_OR), view))
    output.digests.push_back(digest);
  // A lost robot stays lost until it is sure again.
  if (state_ != State::lost || search_.state() == State::converged) state_ = search_.state();
  note("search", watch, output);
  if (search_.state() == State::converged) start_tracking(view, planes);
}

void SGraphLocalization::start_tracking(const View& view, const std::vector<PlaneObservation>& planes) {
  const Candidate& best = search_.candidates().front();
  mass_ = best.mass;
  failed_updates_ = 0;
  storey_ = best.storey;
  watch_.clear();
  unwatched_m_ = 0.0;
  tracker_.emplace(config_.tracker, index_.storeys[static_cast<std::size_t>(best.storey)]);
  tracker_->start(view, planes, pose_in_I(best, view));
  agreement_ = best.agreement;
  X_IO_last_ = tracker_->X_IO();
}

void SGraphLocalization::track(const View& view, const std::vector<PlaneObservation>& planes, Output& output) {
  Stopwatch watch;
  keep(tracker_->update(view, planes));
  X_IO_last_ = tracker_->X_IO();
  output.digests.push_back({"tracking", Digest().add(tracker_->pose(view.X_OR)).value()});
  note("tracking", watch, output);
  monitor(view);
  note("watch", watch, output);
}

/// Some other place has explained the last way better, and goes on doing so: where a wall of the plan is missing, many
/// places do for a while.
bool SGraphLocalization::is_overtaken(const View& view) {
  const Pose2 u = heading(X_OR_update_->inverse() * view.X_OR);
  watch_.follow(index_, u, view);
  unwatched_m_ += u.t.norm();
  if (unwatched_m_ < config_.watch.every_m) return false;
  unwatched_m_ = 0.0;
  const bool second_look = !watch_.candidates().empty();
  if (!second_look) {
    watch_.adopt(index_, std::vector<Place>{{storey_, heading(tracker_->pose(view.X_OR))}});
    const SearchConfig& search = config_.search;
    watch_.adopt(index_,
                 propose_places(index_, {}, view, search.filter.beam_stride, search.likelihood, search.proposals));
  }
  watch_.settle();
  const std::vector<Candidate>& places = watch_.candidates();
  const auto own = std::find_if(places.begin(), places.end(), [&](const Candidate& c) { return is_tracked(c, view); });
  // The ratio alone is no proof: among clutter, places where walls stand in front of much else beat the right one.
  const double through = agreement_.through_others_share() + config_.watch.through_margin;
  const bool worse = std::any_of(places.begin(), places.end(), [&](const Candidate& c) {
    const bool likelier = own == places.end() || c.evidence - own->evidence >= config_.watch.log_ratio;
    return !is_tracked(c, view) && likelier && c.agreement.inliers >= agreement_.inliers &&
           c.agreement.through_others_share() <= through;
  });
  if (!worse || second_look) watch_.forget_places();
  return worse && second_look;
}

bool SGraphLocalization::is_tracked(const Candidate& place, const View& view) const {
  const Pose2 X_IH = heading(tracker_->pose(view.X_OR));
  return place.storey == storey_ &&
         is_near(place.X_IH, X_IH, config_.search.hypotheses.merge_m, config_.search.hypotheses.merge_rad);
}

/// Takes a convergence back when what is seen no longer fits the plan there.
void SGraphLocalization::monitor(const View& view) {
  const Agreement fit = agreement(tracker_->storey(), heading(tracker_->pose(view.X_OR)), view,
                                  config_.search.likelihood, config_.search.refine);
  agreement_.take_in(fit, config_.search.hypotheses.newest);
  failed_updates_ = fit.through_others_share() > config_.watch.lost_through ? failed_updates_ + 1 : 0;
  if (!is_overtaken(view) && failed_updates_ < config_.watch.lost_updates) return;
  tracker_.reset();  // with its window, which is what was refuted
  search_.restart();
  state_ = State::lost;
}

void SGraphLocalization::keep(const std::vector<TrackedPose>& poses) {
  for (const TrackedPose& pose : poses) {
    trail_.add_correction(pose.stamp, pose.X_IR * pose.X_OR.inverse());
    seen_.add(tracker_->storey(), pose);
  }
}

bool SGraphLocalization::is_due(const Pose& X_OR) const {
  if (!X_OR_update_) return true;
  const Pose2 u = heading(X_OR_update_->inverse() * X_OR);
  return u.t.norm() >= config_.update_m || std::abs(u.yaw) >= config_.update_rad;
}

/// The told yaw carried along by the odometry. A robot that is lost may have been carried off and turned.
StartBelief SGraphLocalization::belief(Nanoseconds stamp, const Pose& X_OR) const {
  StartBelief belief;
  if (!input_.prior.yaw_W || state_ == State::lost) return belief;
  const double yaw_I = std::round((*input_.prior.yaw_W - index_.X_WI.yaw()) * 1e9) * 1e-9;
  belief.yaw_I = wrap_angle(yaw_I + X_OR.yaw() - X_OR_start_->yaw());
  belief.yaw_sigma = input_.prior.yaw_sigma + config_.search.convergence.yaw_drift * seconds(stamp);
  return belief;
}

Pose SGraphLocalization::pose_in_I(const Candidate& candidate, const View& view) const {
  const double sensor_z = index_.storeys[static_cast<std::size_t>(candidate.storey)].floor_z + view.sensor_height;
  const double z = sensor_z - (view.q_HR * input_.calibration.X_RL.t).z();
  const Pose X_IH = Pose::from_xyz_yaw({candidate.X_IH.t.x(), candidate.X_IH.t.y(), z}, candidate.X_IH.yaw);
  return X_IH * Pose{view.q_HR, Eigen::Vector3d::Zero()};
}

void SGraphLocalization::say_where(const Pose& X_OR, Output& output) const {
  output.state = state_;
  if (X_IO_last_) output.X_FR = index_.X_WI * (*X_IO_last_ * X_OR);  // [BIM-Loc eq. 10]
  if (tracker_) {
    const int room = tracker_->storey().room_at(tracker_->pose(X_OR).t.head<2>());
    const std::string name = room < 0 ? "" : tracker_->storey().rooms[static_cast<std::size_t>(room)].name;
    output.hypotheses.push_back({mass_, *output.X_FR, turned(tracker_->covariance(), index_.X_WI), name});
  } else {
    const Pose2 u = X_OR_update_ ? heading(*X_OR_update_).inverse() * heading(X_OR) : Pose2{};
    output.hypotheses = hypotheses(u, X_OR);
    show_particles(u, output);
  }
  Digest digest;
  for (const Hypothesis& hypothesis : output.hypotheses) digest.add(hypothesis.mass).add(hypothesis.X_WR);
  output.digests.push_back({"pose", digest.add(static_cast<int>(state_)).value()});
}

std::vector<Hypothesis> SGraphLocalization::hypotheses(const Pose2& u, const Pose& X_OR) const {
  std::vector<Hypothesis> shown;
  for (const Candidate& candidate : search_.candidates()) {
    if (candidate.mass < config_.mass_shown) continue;
    const StoreyIndex& storey = index_.storeys[static_cast<std::size_t>(candidate.storey)];
    const Pose2 X_IH = candidate.X_IH * u;
    const double height = input_.calibration.sensor_height_m - input_.calibration.X_RL.t.z();
    const Pose X_level = Pose::from_xyz_yaw({X_IH.t.x(), X_IH.t.y(), storey.floor_z + height}, X_IH.yaw);
    const Eigen::Quaterniond q_HR = exp_so3({0.0, 0.0, -X_OR.yaw()}) * X_OR.q;
    const int room = storey.room_at(X_IH.t);
    shown.push_back({candidate.mass, index_.X_WI * (X_level * Pose{q_HR, Eigen::Vector3d::Zero()}),
                     turned(candidate.covariance, index_.X_WI),
                     room < 0 ? "" : storey.rooms[static_cast<std::size_t>(room)].name});
  }
  return shown;
}

/// What a robot at each hypothesis takes the walls of the view for.
void SGraphLocalization::show_walls(const View& view, const std::vector<PlaneObservation>& planes,
                                    Output& output) const {
  if (tracker_) {
    output.hypotheses.front().walls = wall_matches(*input_.plan, tracker_->storey(), tracker_->window().back().walls);
    return;
  }
  auto shown = output.hypotheses.begin();
  for (const Candidate& candidate : search_.candidates()) {
    if (candidate.mass < config_.mass_shown) continue;
    const StoreyIndex& storey = index_.storeys[static_cast<std::size_t>(candidate.storey)];
    const Pose X_IR = pose_in_I(candidate, view);
    (shown++)->walls = wall_matches(*input_.plan, storey, associate_walls(storey, view, planes, X_IR, config_.tracker));
  }
}

void SGraphLocalization::show_particles(const Pose2& u, Output& output) const {
  const ParticleSet& particles = search_.particles();
  const std::size_t most = static_cast<std::size_t>(config_.particles_shown);
  const std::size_t stride = std::max<std::size_t>(1, (particles.size() + most - 1) / most);
  const Pose2 X_WI = heading(index_.X_WI);
  for (std::size_t i = 0; i < particles.size(); i += stride) {
    const Pose2 X_WH = X_WI * (particles[i].X_IH * u);
    output.particles.push_back({X_WH.t.x(), X_WH.t.y(), X_WH.yaw, particles[i].weight});
  }
}

Estimate SGraphLocalization::finish() {
  Estimate estimate;
  estimate.frame = Frame::world;
  if (tracker_) keep({tracker_->window().begin(), tracker_->window().end()});
  if (trail_.empty()) return estimate;
  estimate.trajectory = trail_.poses(index_.X_WI);
  estimate.planes = seen_.planes(index_.X_WI);
  estimate.rooms = seen_.rooms(index_.X_WI);
  std::vector<CloudKeyframe> keyframes(cloud_.keyframes().begin(), cloud_.keyframes().end());
  for (std::size_t i = 0; i < keyframes.size(); ++i)
    keyframes[i].X_FR = index_.X_WI * (trail_.correction_at(cloud_stamps_[i], keyframes[i].X_FR) * keyframes[i].X_FR);
  estimate.map_F = map_cloud(keyframes, config_.map);
  return estimate;
}

}  // namespace

std::unique_ptr<Method> make_s_graph_localization(const MethodInput& input, const LocalizationConfig& config) {
  if (!input.plan) throw InputError({}, "s_graph_localization needs a plan; give a plan or an IFC file");
  if (!input.has_odometry) throw InputError({}, "s_graph_localization needs odometry, which there is none of");
  return std::make_unique<SGraphLocalization>(input, config);
}

}  // namespace plumbline::slam
