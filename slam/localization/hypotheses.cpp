// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/hypotheses.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "bim/geometry/symmetric.h"
#include "slam/localization/wall_crossing.h"

namespace plumbline::slam {

namespace {

/// Most poses that are tried are fitted to where another one was: apart by no more than the fits leave open.
bool is_among(const std::vector<StoreyPose>& poses, const StoreyPose& pose) {
  constexpr double same_m = 0.02, same_rad = 0.01;
  return std::any_of(poses.begin(), poses.end(), [&](const StoreyPose& other) {
    return other.storey == pose.storey && is_near(other.X_IH, pose.X_IH, same_m, same_rad);
  });
}

/// The replays of two poses fitted to the last scan are the same but for rounding.
bool begins_alike(const StoreyPose& a, const StoreyPose& b) {
  constexpr double same_m = 0.002, same_rad = 0.001;
  return is_near(a.X_IH, b.X_IH, same_m, same_rad);
}

/// The scan with every nth column of its beam grid.
LocalizationScan thinned(const LocalizationScan& scan, int n) {
  const int columns = scan.beam_grid.columns;
  LocalizationScan thin = scan;
  thin.beam_grid = {(columns + n - 1) / n, {}};
  for (std::size_t i = 0; i < scan.beam_grid.blocks.size(); ++i)
    if (static_cast<int>(i) % columns % n == 0) thin.beam_grid.blocks.push_back(scan.beam_grid.blocks[i]);
  return thin;
}

}  // namespace

double FitConfig::of_scan(const Agreement& seen) const {
  const double other = seen.penetration_ratio_otherwise();
  if (other > misfit_penetration) return -misfit_scan;
  if (seen.inliers < inliers_doubtful || other > other_penetration_max) return -doubtful_scan;
  if (seen.inliers < inliers_min) return 0.0;  // beams cut short neither confirm the pose nor contradict it
  if (seen.penetration_ratio > penetration_max) return missing_wall_scan;
  return std::min(seen.inliers / inliers_full, most_a_scan);
}

FitConfig::Count FitConfig::count_of(const Agreement& seen) const {
  const double fit = of_scan(seen);
  const bool few = seen.inliers >= inliers_doubtful && seen.inliers < inliers_min;
  if (fit < 0.0 || !few || seen.penetration_ratio > clear_penetration) return {fit, 1.0};
  return {std::min(seen.inliers / inliers_full, most_a_scan), seen.inliers / inliers_min};
}

void HypothesisSet::predict_and_update(const PlanIndex& index, const Pose2& u, const LocalizationScan& scan) {
  replayed_reference_.reset();
  ruled_out_.clear();
  const double share = history_.empty() ? 1.0 : config_.fit.share_of_scan(u.t.norm());
  history_.push_back({u, scan, thinned(scan, config_.screening_columns), share});
  if (static_cast<int>(history_.size()) > config_.history) history_.pop_front();
  const auto carry = [&](PoseHypothesis& hypothesis) {
    const StoreyIndex& storey = index.storeys[static_cast<std::size_t>(hypothesis.storey)];
    const Pose2 moved = hypothesis.X_IH * u;
    ScanAtPose own;
    add_crossed_element(storey, hypothesis.X_IH, moved, index.config.body_height_m, own.crossed);
    const Refined refined = refine(storey, moved, scan, likelihood_, tracking_refine_);
    hypothesis.X_IH = own.X_IH = refined.X_IH;
    hypothesis.covariance = refined.covariance;
    update_agreement(agreement(storey, refined.X_IH, scan, likelihood_, refine_), share, hypothesis);
    own.predicted = predict_scan(storey, refined.X_IH, scan, comparison_);
    return own;
  };
  if (hypotheses_.empty()) return;
  const ScanAtPose reference = carry(hypotheses_[reference_]);
  for (std::size_t i = 0; i < hypotheses_.size(); ++i) {
    if (i == reference_) continue;
    accumulate_evidence(scan, carry(hypotheses_[i]), reference, comparison_, hypotheses_[i].balance);
    hypotheses_[i].evidence = hypotheses_[i].balance.evidence(comparison_) + yaw_evidence(hypotheses_[i].X_IH);
  }
  rebase_reference(index);
}

void HypothesisSet::add(const PlanIndex& index, const Clustering& clustering) {
  double covered = 0.0;
  int count = 0;
  for (const PoseCluster& cluster : clustering.clusters) {
    if (covered >= config_.covered_mass) break;
    if (!cluster.compact && cluster.mass >= config_.min_mass) return;
    covered += cluster.mass;
    ++count;
  }
  if (covered < config_.covered_mass || count > config_.max_count) return;
  std::vector<StoreyPose> poses;
  for (const PoseCluster& cluster : clustering.clusters)
    if (cluster.mass >= config_.min_mass && cluster.compact &&
        find({cluster.storey, cluster.mean}, config_.match_m, config_.match_rad) < 0)
      poses.push_back({cluster.storey, cluster.mean});
  add(index, poses);
}

void HypothesisSet::add(const PlanIndex& index, const std::vector<StoreyPose>& poses) {
  if (history_.empty()) return;
  for (const StoreyPose& pose : poses) {
    const Refined refined = refined_at_last_scan(index, pose);
    // An alias keeps its share at exactly its pose; the scan, fitted from there, may pull it aside.
    if (pose.exact) try_pose(index, pose, refined.covariance);
    try_pose(index, {pose.storey, refined.X_IH}, refined.covariance);
  }
  rebase_reference(index);
}

void HypothesisSet::add_best(const PlanIndex& index, const std::vector<StoreyPose>& poses) {
  if (history_.empty()) return;
  const int first = next_id_;
  for (const StoreyPose& pose : poses) {
    const Refined refined = refined_at_last_scan(index, pose);
    const StoreyPose fitted{pose.storey, refined.X_IH};
    if (find(fitted, config_.merge_m, config_.merge_rad) < 0) try_pose(index, fitted, refined.covariance);
  }
  const PoseHypothesis* best = nullptr;
  for (const PoseHypothesis& hypothesis : hypotheses_)
    if (hypothesis.id >= first && (best == nullptr || hypothesis.evidence > best->evidence)) best = &hypothesis;
  if (best == nullptr) return;
  // They stand behind all others, so that the reference keeps its place.
  const int kept = best->id;
  std::erase_if(hypotheses_,
                [&](const PoseHypothesis& hypothesis) { return hypothesis.id >= first && hypothesis.id != kept; });
}

Refined HypothesisSet::refined_at_last_scan(const PlanIndex& index, const StoreyPose& pose) const {
  const StoreyIndex& storey = index.storeys[static_cast<std::size_t>(pose.storey)];
  return refine(storey, pose.X_IH, history_.back().scan, likelihood_, pose.exact ? tracking_refine_ : refine_);
}

void HypothesisSet::try_pose(const PlanIndex& index, const StoreyPose& pose, const Eigen::Matrix3d& covariance) {
  const StoreyIndex& storey = index.storeys[static_cast<std::size_t>(pose.storey)];
  const int known = find(pose, config_.merge_m, config_.merge_rad);
  if (known >= 0 && !pose.exact && !fits_better(storey, pose.X_IH, hypotheses_[static_cast<std::size_t>(known)].X_IH))
    return;
  // A replay begins where the last scan fits, and many of these poses lead to one.
  const StoreyPose start = fitted_to_last_scan(index, pose);
  if (is_among(ruled_out_, start)) return;
  if (known >= 0 &&
      begins_alike(start, fitted_to_last_scan(index, hypotheses_[static_cast<std::size_t>(known)].pose())))
    return;
  const auto rule_out = [&] { ruled_out_.push_back(start); };
  if (is_screened_out(index, start)) return rule_out();
  Replay past = hypotheses_.empty() ? replay(index, start, {}) : replay(index, start, replayed_reference(index).scans);
  const double evidence = past.evidence + (hypotheses_.empty() ? 0.0 : yaw_evidence(pose.X_IH));
  if (past.evidence < -config_.drop_ratio) return rule_out();
  const double margin = pose.exact ? 0.0 : config_.reference_switch_margin;
  if (known >= 0 && evidence <= hypotheses_[static_cast<std::size_t>(known)].evidence + margin) return;
  PoseHypothesis& hypothesis = hypotheses_.emplace_back();
  hypothesis.id = next_id_++;
  hypothesis.storey = pose.storey;
  hypothesis.X_IH = pose.X_IH;
  hypothesis.covariance = covariance;
  hypothesis.balance = std::move(past.balance);
  hypothesis.evidence = evidence;
  replay_agreement(storey, past.scans, hypothesis);
  if (hypotheses_.size() == 1) replayed_reference_ = {pose, std::move(past.scans), {}};
}

bool HypothesisSet::fits_better(const StoreyIndex& storey, const Pose2& X_IH, const Pose2& other) const {
  const LocalizationScan& scan = history_.back().scan;
  return compare_hypotheses(scan, predict_scan(storey, X_IH, scan, comparison_),
                            predict_scan(storey, other, scan, comparison_), comparison_)
             .ratio > config_.deadband;
}

void HypothesisSet::prune_and_normalize() {
  if (hypotheses_.empty()) return;
  const PoseHypothesis reference = hypotheses_[reference_];
  std::stable_sort(hypotheses_.begin(), hypotheses_.end(),
                   [](const PoseHypothesis& a, const PoseHypothesis& b) { return a.evidence > b.evidence; });
  std::vector<PoseHypothesis> kept;
  for (const PoseHypothesis& hypothesis : hypotheses_) {
    // The reference stays until the others are compared with a new one.
    const bool hopeless = hypothesis.evidence < hypotheses_.front().evidence - config_.drop_ratio;
    if (hopeless && hypothesis.id != reference.id) continue;
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const PoseHypothesis& other) {
      return other.storey == hypothesis.storey &&
             is_near(other.X_IH, hypothesis.X_IH, config_.merge_m, config_.merge_rad);
    });
    if (!known) kept.push_back(hypothesis);
  }
  double sum = 0.0;
  for (PoseHypothesis& hypothesis : kept)
    sum += hypothesis.mass = std::exp(hypothesis.evidence - kept.front().evidence);
  for (PoseHypothesis& hypothesis : kept) hypothesis.mass /= sum;
  hypotheses_ = std::move(kept);
  const auto kept_as = std::find_if(hypotheses_.begin(), hypotheses_.end(),
                                    [&](const PoseHypothesis& c) { return c.id == reference.id; });
  reference_ = static_cast<std::size_t>(kept_as != hypotheses_.end()
                                            ? kept_as - hypotheses_.begin()
                                            : find(reference.pose(), config_.merge_m, config_.merge_rad));
}

void HypothesisSet::reweight_particles(ParticleSet& particles, const Clustering& clustering, int quota,
                                       std::uint64_t seed, std::uint64_t tick) const {
  if (hypotheses_.empty()) return;
  std::vector<double> mass_of_hypothesis(hypotheses_.size(), 0.0);
  std::vector<int> hypothesis_of_cluster;
  double unassigned = 0.0;
  for (const PoseCluster& cluster : clustering.clusters) {
    const int i = find({cluster.storey, cluster.mean}, config_.match_m, config_.match_rad);
    hypothesis_of_cluster.push_back(i);
    (i >= 0 ? mass_of_hypothesis[static_cast<std::size_t>(i)] : unassigned) += cluster.mass;
  }
  for (LocalParticle& particle : particles) {
    const int i = particle.cluster < 0 ? -1 : hypothesis_of_cluster[static_cast<std::size_t>(particle.cluster)];
    if (i >= 0) {
      const auto c = static_cast<std::size_t>(i);
      particle.weight *= (1.0 - config_.unassigned_mass) * hypotheses_[c].mass / mass_of_hypothesis[c];
    } else {
      particle.weight *=
          particle.cluster < 0 || unassigned <= 0.0 ? config_.unassigned_mass : config_.unassigned_mass / unassigned;
    }
  }
  const Stream stream(seed, "slam.localize.recover");
  for (std::size_t c = 0; c < hypotheses_.size(); ++c) {
    if (mass_of_hypothesis[c] > 0.0) continue;
    const PoseHypothesis& hypothesis = hypotheses_[c];
    const Eigen::Matrix3d root = hypothesis.covariance.llt().matrixL();
    for (int k = 0; k < quota; ++k) {
      const auto lane = static_cast<std::uint32_t>(hypothesis.id);
      const auto draw = static_cast<std::uint32_t>(3 * k);
      const Eigen::Vector3d e =
          root * Eigen::Vector3d(stream.gauss(tick, lane, draw), stream.gauss(tick, lane, draw + 1),
                                 stream.gauss(tick, lane, draw + 2));
      particles.push_back({{hypothesis.X_IH.t + e.head<2>(), wrap_angle(hypothesis.X_IH.yaw + e.z())},
                           hypothesis.storey,
                           hypothesis.mass / quota,
                           -1});
    }
  }
  normalise(particles);
}

void HypothesisSet::clear() {
  hypotheses_.clear();
  history_.clear();
  replayed_reference_.reset();
  ruled_out_.clear();
  reference_ = 0;
}

void HypothesisSet::update_agreement(const Agreement& latest, double share, PoseHypothesis& hypothesis) const {
  hypothesis.agreement.update_mean(latest, config_.ema_alpha);
  const FitConfig::Count count = config_.fit.count_of(latest);
  hypothesis.fit = std::clamp(hypothesis.fit + share * count.fit, -config_.fit.limit, config_.fit.limit);
  hypothesis.fit_sum += share * count.fit;
  hypothesis.scans += share * count.scans;
}

void HypothesisSet::rebase_reference(const PlanIndex& index) {
  const auto best =
      std::max_element(hypotheses_.begin(), hypotheses_.end(),
                       [](const PoseHypothesis& a, const PoseHypothesis& b) { return a.evidence < b.evidence; });
  if (best == hypotheses_.end() || best->evidence <= hypotheses_[reference_].evidence + config_.reference_switch_margin)
    return;
  reference_ = static_cast<std::size_t>(best - hypotheses_.begin());
  compare_all_with_reference(index);
}

// Beams at the few faces across it are too few for Gauss-Newton, and enough to contradict a pose that is off.
void HypothesisSet::slide_along_open_direction(const PlanIndex& index, PoseHypothesis& hypothesis) const {
  const auto axes = symmetric_eigen(Eigen::Matrix2d(hypothesis.covariance.topLeftCorner<2, 2>()));
  if (std::sqrt(axes.values[1]) < config_.open_share * refine_.prior_sigma_m) return;
  const Eigen::Vector2d along = axes.vectors.col(1);
  const StoreyIndex& storey = index.storeys[static_cast<std::size_t>(hypothesis.storey)];
  const LocalizationScan& scan = history_.back().scan;
  const auto cost_at = [&](double shift_m) {
    const Pose2 X_IH{hypothesis.X_IH.t + shift_m * along, hypothesis.X_IH.yaw};
    return total_cost(scan, predict_scan(storey, X_IH, scan, comparison_), comparison_);
  };
  double best_m = 0.0, best = cost_at(0.0);
  const auto try_at = [&](double shift_m) {
    if (const double cost = cost_at(shift_m); cost < best) best = cost, best_m = shift_m;
  };
  for (double step = config_.slide_step_m; step <= config_.slide_m; step += config_.slide_step_m)
    for (const double shift_m : {step, -step}) try_at(shift_m);
  constexpr int halvings = 3;
  double step = 0.5 * config_.slide_step_m;
  for (int i = 0; i < halvings; ++i, step *= 0.5)
    for (const double shift_m : {best_m + step, best_m - step}) try_at(shift_m);
  hypothesis.X_IH.t += best_m * along;
}

void HypothesisSet::reassess(const PlanIndex& index) {
  if (hypotheses_.size() < 2 || history_.empty()) return;
  for (PoseHypothesis& hypothesis : hypotheses_) slide_along_open_direction(index, hypothesis);
  compare_all_with_reference(index);
  rebase_reference(index);
}

double HypothesisSet::yaw_evidence(const Pose2& X_IH) const {
  if (!expected_yaw_) return 0.0;
  // Normal about what is expected or uniform, with even odds.
  const auto log_density = [&](double yaw) {
    const double e = wrap_angle(yaw - expected_yaw_->yaw_I) / expected_yaw_->sigma;
    return std::log1p(std::sqrt(2.0 * std::numbers::pi) / expected_yaw_->sigma * std::exp(-0.5 * e * e));
  };
  return log_density(X_IH.yaw) - log_density(hypotheses_[reference_].X_IH.yaw);
}

int HypothesisSet::find(const StoreyPose& pose, double near_m, double near_rad) const {
  for (std::size_t i = 0; i < hypotheses_.size(); ++i)
    if (hypotheses_[i].storey == pose.storey && is_near(hypotheses_[i].X_IH, pose.X_IH, near_m, near_rad))
      return static_cast<int>(i);
  return -1;
}

}  // namespace plumbline::slam
