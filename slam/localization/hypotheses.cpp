// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/hypotheses.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "slam/localization/wall_crossing.h"

namespace plumbline::slam {

namespace {

/// Adds the wall or column that a step goes through, if any.
void add_crossed(const StoreyIndex& storey, const Pose2& from, const Pose2& to, double body_height,
                 std::vector<int>& elements) {
  const int element = crossed_element(storey, from, to, body_height);
  if (element >= 0) elements.push_back(element);
}

/// Most poses that are tried are fitted to where another one was: apart by no more than the fits leave open.
bool is_among(const std::vector<StoreyPose>& poses, const StoreyPose& pose) {
  constexpr double same_m = 0.02, same_rad = 0.01;
  return std::any_of(poses.begin(), poses.end(), [&](const StoreyPose& other) {
    return other.storey == pose.storey && is_near(other.X_IH, pose.X_IH, same_m, same_rad);
  });
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
  const double other = seen.penetration_ratio_other_walls();
  if (other > misfit_penetration) return -misfit_scan;
  if (seen.inliers < inliers_doubtful || other > other_penetration_max) return -doubtful_scan;
  if (seen.inliers < inliers_min) return 0.0;  // beams cut short neither confirm the pose nor contradict it
  if (seen.penetration_ratio > penetration_max) return missing_wall_scan;
  return std::min(seen.inliers / inliers_full, most_a_scan);
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
    add_crossed(storey, hypothesis.X_IH, moved, index.config.body_height_m, own.crossed);
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
  const LocalizationScan& scan = history_.back().scan;
  for (const StoreyPose& pose : poses) {
    const StoreyIndex& storey = index.storeys[static_cast<std::size_t>(pose.storey)];
    const Refined refined = refine(storey, pose.X_IH, scan, likelihood_, pose.exact ? tracking_refine_ : refine_);
    // An alias keeps its share at exactly its pose; the scan, fitted from there, may pull it aside.
    if (pose.exact) try_pose(index, pose, refined.covariance);
    try_pose(index, {pose.storey, refined.X_IH}, refined.covariance);
  }
  rebase_reference(index);
}

void HypothesisSet::try_pose(const PlanIndex& index, const StoreyPose& pose, const Eigen::Matrix3d& covariance) {
  const StoreyIndex& storey = index.storeys[static_cast<std::size_t>(pose.storey)];
  const int known = find(pose, config_.merge_m, config_.merge_rad);
  if (known >= 0 && !pose.exact && !fits_better(storey, pose.X_IH, hypotheses_[static_cast<std::size_t>(known)].X_IH))
    return;
  // A replay begins where the last scan fits, and many of these poses lead to one.
  const StoreyPose start = fitted_to_last_scan(index, pose);
  if (is_among(ruled_out_, start)) return;
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

StoreyPose HypothesisSet::fitted_to_last_scan(const PlanIndex& index, const StoreyPose& pose) const {
  const StoreyIndex& storey = index.storeys[static_cast<std::size_t>(pose.storey)];
  return {pose.storey, refine(storey, pose.X_IH, history_.back().scan, likelihood_, tracking_refine_).X_IH};
}

// One scan of a turn may be off. It must not stand for others where all of them can be replayed.
std::size_t HypothesisSet::replay_stride() const {
  const auto stride = static_cast<std::size_t>(config_.replay_stride);
  const std::size_t most = std::max<std::size_t>(1, static_cast<std::size_t>(config_.history) / stride);
  return std::max<std::size_t>(1, (history_.size() + most - 1) / most);
}

const HypothesisSet::ReplayedReference& HypothesisSet::replayed_reference(const PlanIndex& index) {
  const StoreyPose pose = hypotheses_[reference_].pose();
  const auto is_kept = [&](const ReplayedReference& kept) {
    return kept.pose.storey == pose.storey && kept.pose.X_IH.t == pose.X_IH.t && kept.pose.X_IH.yaw == pose.X_IH.yaw;
  };
  if (!replayed_reference_ || !is_kept(*replayed_reference_))
    replayed_reference_ = {pose, replay(index, fitted_to_last_scan(index, pose), {}).scans, {}};
  return *replayed_reference_;
}

const std::vector<HypothesisSet::ScanAtPose>& HypothesisSet::screening_of_reference(const PlanIndex& index) {
  static_cast<void>(replayed_reference(index));
  if (replayed_reference_->screening.empty())
    replayed_reference_->screening =
        replay(index, fitted_to_last_scan(index, replayed_reference_->pose), {}, Grid::screening).scans;
  return replayed_reference_->screening;
}

bool HypothesisSet::is_screened_out(const PlanIndex& index, const StoreyPose& start) {
  if (hypotheses_.empty() || config_.screening_columns == 1) return false;
  return replay(index, start, screening_of_reference(index), Grid::screening).evidence <
         -config_.drop_ratio - config_.screening_margin;
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
  const double fit = share * config_.fit.of_scan(latest);
  hypothesis.fit = std::clamp(hypothesis.fit + fit, -config_.fit.limit, config_.fit.limit);
  hypothesis.fit_sum += fit;
  hypothesis.scans += share;
}

void HypothesisSet::replay_agreement(const StoreyIndex& storey, const std::vector<ScanAtPose>& scans,
                                     PoseHypothesis& hypothesis) const {
  const std::size_t stride = replay_stride();
  for (std::size_t k = scans.size(); k-- > 0;) {
    const LocalizationScan& scan = history_[history_.size() - 1 - k * stride].scan;
    const Agreement seen = agreement(storey, scans[k].X_IH, scan, likelihood_, refine_);
    if (k + 1 == scans.size()) hypothesis.agreement = seen;
    for (std::size_t i = 0; i < static_cast<std::size_t>(scans[k].represented_scans); ++i)
      update_agreement(seen, history_[history_.size() - 1 - k * stride - i].share, hypothesis);
  }
}

void HypothesisSet::replay_best_agreement(const PlanIndex& index) {
  if (hypotheses_.empty() || history_.empty()) return;
  PoseHypothesis& best = hypotheses_.front();
  best.fit = best.fit_sum = best.scans = 0.0;
  replay_agreement(index.storeys[static_cast<std::size_t>(best.storey)],
                   replay(index, fitted_to_last_scan(index, best.pose()), {}).scans, best);
}

void HypothesisSet::accumulate_evidence(const LocalizationScan& scan, const ScanAtPose& own,
                                        const ScanAtPose& reference, const HypothesisComparisonConfig& config,
                                        EvidenceBalance& balance) const {
  const auto add_crossings = [&](const std::vector<int>& more, const std::vector<int>& than,
                                 EvidenceByCause& evidence) {
    for (std::size_t i = than.size(); i < more.size(); ++i)
      evidence.add({OutlierCause::Kind::not_built, more[i]}, config_.crossing_cost);
  };
  add_crossings(own.crossed, reference.crossed, balance.against);
  add_crossings(reference.crossed, own.crossed, balance.supporting);
  const PairwiseLikelihoodRatio comparison = compare_hypotheses(scan, own.predicted, reference.predicted, config);
  const double size = std::abs(comparison.ratio);
  if (size <= config_.deadband) return;
  const double scale = own.represented_scans * std::min(size - config_.deadband, config_.step_cap) / size;
  balance.against.add(comparison.against_a, scale);
  balance.supporting.add(comparison.against_b, scale);
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
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(hypothesis.covariance.topLeftCorner<2, 2>());
  if (std::sqrt(axes.eigenvalues()[1]) < config_.open_share * refine_.prior_sigma_m) return;
  const Eigen::Vector2d along = axes.eigenvectors().col(1);
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

void HypothesisSet::compare_all_with_reference(const PlanIndex& index) {
  const std::vector<ScanAtPose>& scans = replayed_reference(index).scans;
  for (PoseHypothesis& hypothesis : hypotheses_) {
    Replay past;
    if (&hypothesis != &hypotheses_[reference_])
      past = replay(index, fitted_to_last_scan(index, hypothesis.pose()), scans);
    hypothesis.balance = std::move(past.balance);
    hypothesis.evidence = past.evidence + yaw_evidence(hypothesis.X_IH);
  }
}

HypothesisSet::Replay HypothesisSet::replay(const PlanIndex& index, const StoreyPose& start,
                                            const std::vector<ScanAtPose>& reference, Grid grid) const {
  const StoreyIndex& storey = index.storeys[static_cast<std::size_t>(start.storey)];
  const bool screening = grid == Grid::screening;
  const HypothesisComparisonConfig& comparison = screening ? screening_ : comparison_;
  const double dropped = -config_.drop_ratio - (screening ? config_.screening_margin : 0.0);
  const std::size_t stride = screening ? static_cast<std::size_t>(config_.replay_stride) : replay_stride();
  Pose2 X = start.X_IH;
  Replay past;
  std::vector<int> crossed;
  for (std::size_t back = 0; back < history_.size(); ++back) {
    const HistoryStep& step = history_[history_.size() - 1 - back];
    const LocalizationScan& scan = screening ? step.screening : step.scan;
    const bool is_sampled = back % stride == 0;
    if (is_sampled && back > 0) X = refine(storey, X, scan, likelihood_, tracking_refine_).X_IH;
    const Pose2 before = X * step.u.inverse();
    add_crossed(storey, before, X, index.config.body_height_m, crossed);
    if (is_sampled) {
      const int represented_scans = static_cast<int>(std::min(stride, history_.size() - back));
      past.scans.push_back({X, predict_scan(storey, X, scan, comparison), std::move(crossed), represented_scans});
      crossed.clear();
    }
    X = before;
    const std::size_t k = past.scans.size() - 1;
    if (!is_sampled || k >= reference.size()) continue;
    accumulate_evidence(scan, past.scans[k], reference[k], comparison, past.balance);
    past.scans[k].predicted = {};
    past.evidence = past.balance.evidence(comparison_);
    if (past.evidence < dropped) break;
  }
  return past;
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
