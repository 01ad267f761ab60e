// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/hypotheses.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

namespace plumbline::slam {

namespace {

/// Adds the element of the plan that a step goes through, if any.
void add_crossed(const StoreyIndex& storey, const Pose2& from, const Pose2& to, double body_height,
                 std::vector<int>& elements) {
  const Eigen::Vector2d way = to.t - from.t;
  if (way.norm() < 1e-6) return;
  const PlanRay ray{from.t, way.normalized(), storey.floor_z + body_height, 0.0};
  const int segment = storey.grid.cast(storey.segments, ray, way.norm()).segment;
  if (segment >= 0) elements.push_back(storey.segments[static_cast<std::size_t>(segment)].element);
}

}  // namespace

void HypothesisSet::follow(const PlanIndex& index, const Pose2& u, const View& view) {
  history_.push_back({u, view});
  if (static_cast<int>(history_.size()) > config_.history) history_.pop_front();
  const auto carry = [&](Candidate& candidate) {
    const StoreyIndex& storey = index.storeys[static_cast<std::size_t>(candidate.storey)];
    const Pose2 moved = candidate.X_IH * u;
    Look look;
    add_crossed(storey, candidate.X_IH, moved, index.config.body_height_m, look.crossed);
    const Refined refined = refine(storey, moved, view, likelihood_, follow_);
    candidate.X_IH = look.X_IH = refined.X_IH;
    candidate.covariance = refined.covariance;
    note(agreement(storey, refined.X_IH, view, likelihood_, refine_), candidate);
    look.sight = sight(storey, refined.X_IH, view, contest_);
    return look;
  };
  if (candidates_.empty()) return;
  const Look reference = carry(candidates_[reference_]);
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    if (i == reference_) continue;
    judge(view, carry(candidates_[i]), reference, candidates_[i].held);
    candidates_[i].evidence = candidates_[i].held.evidence(contest_.cause_cap);
  }
  agree_on_reference(index);
}

void HypothesisSet::adopt(const PlanIndex& index, const Clustering& clustering) {
  double covered = 0.0;
  int count = 0;
  for (const PoseCluster& cluster : clustering.clusters) {
    if (covered >= config_.covered_mass) break;
    if (!cluster.compact && cluster.mass >= config_.min_mass) return;
    covered += cluster.mass;
    ++count;
  }
  if (covered < config_.covered_mass || count > config_.max_count) return;
  std::vector<Place> places;
  for (const PoseCluster& cluster : clustering.clusters)
    if (cluster.mass >= config_.min_mass && cluster.compact &&
        find({cluster.storey, cluster.mean}, config_.match_m, config_.match_rad) < 0)
      places.push_back({cluster.storey, cluster.mean});
  adopt(index, places);
}

void HypothesisSet::adopt(const PlanIndex& index, const std::vector<Place>& places) {
  if (history_.empty()) return;
  const View& view = history_.back().view;
  std::vector<Look> reference;
  for (const Place& place : places) {
    if (find(place, config_.merge_m, config_.merge_rad) >= 0) continue;
    const StoreyIndex& storey = index.storeys[static_cast<std::size_t>(place.storey)];
    const Refined refined = refine(storey, place.X_IH, view, likelihood_, place.exact ? follow_ : refine_);
    const Place fitted{place.storey, refined.X_IH};
    if (find(fitted, config_.merge_m, config_.merge_rad) >= 0) continue;
    if (reference.empty() && !candidates_.empty()) reference = replay(index, candidates_[reference_].place(), {}).looks;
    Replay past = replay(index, fitted, reference);
    if (past.evidence < -config_.drop_ratio) continue;
    candidates_.push_back(
        {next_id_++, fitted.storey, fitted.X_IH, refined.covariance, std::move(past.held), past.evidence, 0.0, 0, {}});
    note_past(storey, past.looks, candidates_.back());
    if (reference.empty()) reference = std::move(past.looks);
  }
  agree_on_reference(index);
}

void HypothesisSet::settle() {
  if (candidates_.empty()) return;
  const Candidate reference = candidates_[reference_];
  std::stable_sort(candidates_.begin(), candidates_.end(),
                   [](const Candidate& a, const Candidate& b) { return a.evidence > b.evidence; });
  std::vector<Candidate> kept;
  for (const Candidate& candidate : candidates_) {
    // The one that all are held against stays until they are held against another.
    const bool hopeless = candidate.evidence < candidates_.front().evidence - config_.drop_ratio;
    if (hopeless && candidate.id != reference.id) continue;
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const Candidate& other) {
      return other.storey == candidate.storey &&
             is_near(other.X_IH, candidate.X_IH, config_.merge_m, config_.merge_rad);
    });
    if (!known) kept.push_back(candidate);
  }
  double sum = 0.0;
  for (Candidate& candidate : kept) sum += candidate.mass = std::exp(candidate.evidence - kept.front().evidence);
  for (Candidate& candidate : kept) candidate.mass /= sum;
  candidates_ = std::move(kept);
  const auto kept_as =
      std::find_if(candidates_.begin(), candidates_.end(), [&](const Candidate& c) { return c.id == reference.id; });
  reference_ = static_cast<std::size_t>(kept_as != candidates_.end()
                                            ? kept_as - candidates_.begin()
                                            : find(reference.place(), config_.merge_m, config_.merge_rad));
}

void HypothesisSet::impose(ParticleSet& particles, const Clustering& clustering, int quota, std::uint64_t seed,
                           std::uint64_t tick) const {
  if (candidates_.empty()) return;
  std::vector<double> mass_of_candidate(candidates_.size(), 0.0);
  std::vector<int> candidate_of_cluster;
  double stray = 0.0;
  for (const PoseCluster& cluster : clustering.clusters) {
    const int i = find({cluster.storey, cluster.mean}, config_.match_m, config_.match_rad);
    candidate_of_cluster.push_back(i);
    (i >= 0 ? mass_of_candidate[static_cast<std::size_t>(i)] : stray) += cluster.mass;
  }
  for (LocalParticle& particle : particles) {
    const int i = particle.cluster < 0 ? -1 : candidate_of_cluster[static_cast<std::size_t>(particle.cluster)];
    if (i >= 0) {
      const auto c = static_cast<std::size_t>(i);
      particle.weight *= (1.0 - config_.stray_mass) * candidates_[c].mass / mass_of_candidate[c];
    } else {
      particle.weight *= particle.cluster < 0 || stray <= 0.0 ? config_.stray_mass : config_.stray_mass / stray;
    }
  }
  const Stream stream(seed, "slam.localize.recover");
  for (std::size_t c = 0; c < candidates_.size(); ++c) {
    if (mass_of_candidate[c] > 0.0) continue;
    const Candidate& candidate = candidates_[c];
    const Eigen::Matrix3d root = candidate.covariance.llt().matrixL();
    for (int k = 0; k < quota; ++k) {
      const auto lane = static_cast<std::uint32_t>(candidate.id);
      const auto draw = static_cast<std::uint32_t>(3 * k);
      const Eigen::Vector3d e =
          root * Eigen::Vector3d(stream.gauss(tick, lane, draw), stream.gauss(tick, lane, draw + 1),
                                 stream.gauss(tick, lane, draw + 2));
      particles.push_back({{candidate.X_IH.t + e.head<2>(), wrap_angle(candidate.X_IH.yaw + e.z())},
                           candidate.storey,
                           candidate.mass / quota,
                           -1});
    }
  }
  normalise(particles);
}

void HypothesisSet::clear() {
  candidates_.clear();
  history_.clear();
  reference_ = 0;
}

void HypothesisSet::note(const Agreement& newest, Candidate& candidate) const {
  Agreement& mean = candidate.agreement;
  mean.take_in(newest, config_.newest);
  const bool fits =
      mean.inliers >= config_.cluttered_inliers && mean.through_others_share() <= config_.cluttered_through;
  candidate.fits = fits ? candidate.fits + 1 : std::max(config_.least_fits, candidate.fits - 2);
}

void HypothesisSet::note_past(const StoreyIndex& storey, const std::vector<Look>& looks, Candidate& candidate) const {
  const auto stride = static_cast<std::size_t>(config_.replay_stride);
  for (std::size_t k = looks.size(); k-- > 0;) {
    const View& view = history_[history_.size() - 1 - k * stride].view;
    const Agreement seen = agreement(storey, looks[k].X_IH, view, likelihood_, refine_);
    if (k + 1 == looks.size()) candidate.agreement = seen;
    for (int i = 0; i < looks[k].views; ++i) note(seen, candidate);
  }
}

void HypothesisSet::judge(const View& view, const Look& look, const Look& reference, Case& held) const {
  const auto add_crossings = [&](const std::vector<int>& more, const std::vector<int>& than, Objections& objections) {
    for (std::size_t i = than.size(); i < more.size(); ++i)
      objections.add({Cause::Kind::not_built, more[i]}, config_.crossing_cost);
  };
  add_crossings(look.crossed, reference.crossed, held.against);
  add_crossings(reference.crossed, look.crossed, held.for_it);
  const Contest said = contest(view, look.sight, reference.sight, contest_);
  const double size = std::abs(said.ratio);
  if (size <= config_.indifference) return;
  const double scale = look.views * std::min(size - config_.indifference, config_.step_cap) / size;
  held.against.add(said.against_a, scale);
  held.for_it.add(said.against_b, scale);
}

void HypothesisSet::agree_on_reference(const PlanIndex& index) {
  const auto best = std::max_element(candidates_.begin(), candidates_.end(),
                                     [](const Candidate& a, const Candidate& b) { return a.evidence < b.evidence; });
  if (best == candidates_.end() || best->evidence <= candidates_[reference_].evidence + config_.overtaking) return;
  reference_ = static_cast<std::size_t>(best - candidates_.begin());
  const std::vector<Look> looks = replay(index, best->place(), {}).looks;
  for (Candidate& candidate : candidates_) {
    Replay past;
    if (&candidate != &*best) past = replay(index, candidate.place(), looks);
    candidate.held = std::move(past.held);
    candidate.evidence = past.evidence;
  }
}

HypothesisSet::Replay HypothesisSet::replay(const PlanIndex& index, const Place& place,
                                            const std::vector<Look>& reference) const {
  const StoreyIndex& storey = index.storeys[static_cast<std::size_t>(place.storey)];
  Pose2 X = place.X_IH;
  Replay past;
  std::vector<int> crossed;
  const auto stride = static_cast<std::size_t>(config_.replay_stride);
  for (std::size_t back = 0; back < history_.size(); ++back) {
    const Step& step = history_[history_.size() - 1 - back];
    const bool looks = back % stride == 0;
    if (looks) X = refine(storey, X, step.view, likelihood_, follow_).X_IH;
    const Pose2 before = X * step.u.inverse();
    add_crossed(storey, before, X, index.config.body_height_m, crossed);
    if (looks) {
      const int views = static_cast<int>(std::min(stride, history_.size() - back));
      past.looks.push_back({X, sight(storey, X, step.view, contest_), std::move(crossed), views});
      crossed.clear();
    }
    X = before;
    const std::size_t k = past.looks.size() - 1;
    if (!looks || k >= reference.size()) continue;
    judge(step.view, past.looks[k], reference[k], past.held);
    past.looks[k].sight = {};
    past.evidence = past.held.evidence(contest_.cause_cap);
    if (past.evidence < -config_.drop_ratio) break;
  }
  return past;
}

int HypothesisSet::find(const Place& place, double near_m, double near_rad) const {
  for (std::size_t i = 0; i < candidates_.size(); ++i)
    if (candidates_[i].storey == place.storey && is_near(candidates_[i].X_IH, place.X_IH, near_m, near_rad))
      return static_cast<int>(i);
  return -1;
}

}  // namespace plumbline::slam
