// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/global_localizer.h"

#include <algorithm>
#include <cmath>

#include "bim/digest/digest.h"

namespace plumbline::slam {

namespace {

std::uint64_t digest_of(const ParticleSet& particles) {
  Digest digest;
  for (const LocalParticle& p : particles) digest.add(p.X_IH.t).add(p.X_IH.yaw).add(p.weight).add(p.storey);
  return digest.value();
}

std::uint64_t digest_of(const Clustering& clustering) {
  Digest digest;
  for (const PoseCluster& c : clustering.clusters) digest.add(c.mass).add(c.mean.t).add(c.mean.yaw).add(c.count);
  return digest.value();
}

std::uint64_t digest_of(const std::vector<Candidate>& candidates) {
  Digest digest;
  for (const Candidate& c : candidates) digest.add(c.id).add(c.X_IH.t).add(c.X_IH.yaw).add(c.evidence);
  return digest.value();
}

/// The most likely particles, no two of them near each other; ties: lowest index.
std::vector<LocalParticle> best_apart(ParticleSet particles, const ConvergenceConfig& config) {
  std::stable_sort(particles.begin(), particles.end(),
                   [](const LocalParticle& a, const LocalParticle& b) { return a.weight > b.weight; });
  std::vector<LocalParticle> best;
  for (const LocalParticle& particle : particles) {
    if (static_cast<int>(best.size()) >= config.rivals) break;
    const bool apart = std::none_of(best.begin(), best.end(), [&](const LocalParticle& other) {
      return other.storey == particle.storey &&
             is_near(other.X_IH, particle.X_IH, config.rival_gap_m, config.rival_gap_rad);
    });
    if (apart) best.push_back(particle);
  }
  return best;
}

}  // namespace

PlanSearch::PlanSearch(SearchConfig config, std::uint64_t seed)
    : config_(config), seed_(seed), hypotheses_(config.hypotheses, config.refine, config.likelihood, config.contest) {}

std::vector<StageDigest> PlanSearch::update(const PlanIndex& index, const StartBelief& start, const View& view) {
  const Pose2 X_OH = heading(view.X_OR);
  const Pose2 u = last_X_OH_ ? last_X_OH_->inverse() * X_OH : Pose2{};
  last_X_OH_ = X_OH;
  ++tick_;
  std::vector<StageDigest> digests;
  const auto done = [&](const char* stage, std::uint64_t digest) { digests.push_back({stage, digest}); };

  if (particles_.empty())
    particles_ = draw_start(index, start, view, config_.filter, seed_, tick_);
  else
    propagate(particles_, u, index, config_.filter, seed_, tick_);  // [BIM-Loc eq. 4-5]
  done("motion", digest_of(particles_));

  const Reweighting weighting =
      reweight(particles_, view, index, config_.likelihood, config_.filter);  // [BIM-Loc eq. 6-9]
  done("likelihood", digest_of(particles_));

  const Clustering clustering = find_clusters(particles_, config_.clusters);
  done("clusters", digest_of(clustering));

  hypotheses_.follow(index, u, view);
  const bool first = hypotheses_.candidates().empty();
  hypotheses_.adopt(index, clustering);
  hypotheses_.settle();
  // Particles may have died out by chance where the plan repeats itself; look there before the first word.
  unlooked_m_ = first ? config_.convergence.rivals_every_m : unlooked_m_ + u.t.norm();
  if (unlooked_m_ >= config_.convergence.rivals_every_m && !hypotheses_.candidates().empty())
    find_rivals(index, start, view);
  judge(index, start, view, u.t.norm());
  done("hypotheses", digest_of(hypotheses_.candidates()));

  if (particles_.empty()) return digests;  // nothing in the plan fits: the next update starts anew
  const int quota = hypotheses_.candidates().empty() ? 0 : config_.filter.quota;
  hypotheses_.impose(particles_, clustering, quota, seed_, tick_);
  const double size = static_cast<double>(particles_.size());
  if (weighting.effective < config_.filter.ess_resample * size || quota > 0)
    particles_ = resample(particles_, clustering, kld_size(clustering.occupied_bins, config_.filter), quota,
                          config_.filter, seed_, tick_);
  done("resample", digest_of(particles_));
  return digests;
}

void PlanSearch::restart() {
  particles_.clear();
  hypotheses_.clear();
  last_X_OH_.reset();  // what is walked until the next update is no one step
  state_ = State::searching;
  sure_updates_ = failed_updates_ = 0;
  sure_travel_m_ = 0.0;
}

void PlanSearch::judge(const PlanIndex& index, const StartBelief& start, const View& view, double walked) {
  const ConvergenceConfig& c = config_.convergence;
  const std::vector<Candidate>& candidates = hypotheses_.candidates();
  state_ = State::searching;
  if (candidates.empty()) return;
  const auto sure_of_best = [&] {
    const Candidate& best = candidates.front();
    return best.mass >= c.top_mass && (candidates.size() < 2 || best.evidence - candidates[1].evidence >= c.log_ratio);
  };
  if (candidates.size() > 1 && !sure_of_best()) state_ = State::ambiguous;

  const Agreement& fit = candidates.front().agreement;
  const bool fits =
      (fit.inliers >= c.inliers_min && fit.through <= c.through_max) || candidates.front().fits >= c.cluttered_updates;
  failed_updates_ = fit.through_others_share() > c.restart_through ? failed_updates_ + 1 : 0;
  if (failed_updates_ >= c.restart_updates) return restart();

  const bool sure = fits && sure_of_best();
  sure_travel_m_ = sure && sure_updates_ > 0 ? sure_travel_m_ + walked : 0.0;
  sure_updates_ = sure ? sure_updates_ + 1 : 0;
  if (sure_updates_ < c.updates || sure_travel_m_ < c.travel_m) return;
  find_rivals(index, start, view);
  if (!sure_of_best()) {
    sure_updates_ = 0;
    state_ = State::ambiguous;
    return;
  }
  state_ = State::converged;
}

void PlanSearch::find_rivals(const PlanIndex& index, const StartBelief& start, const View& view) {
  unlooked_m_ = 0.0;
  StartBelief belief = start;
  if (belief.yaw_I) belief.yaw_I = hypotheses_.candidates().front().X_IH.yaw;
  ParticleSet sample = draw_start(index, belief, view, config_.filter, seed_, tick_);
  FilterConfig untempered = config_.filter;
  untempered.ess_floor = 0.0;
  static_cast<void>(reweight(sample, view, index, config_.likelihood, untempered));
  std::vector<Place> places =
      propose_places(index, belief, view, config_.filter.beam_stride, config_.likelihood, config_.proposals);
  for (const LocalParticle& particle : best_apart(std::move(sample), config_.convergence))
    places.push_back({particle.storey, particle.X_IH});
  hypotheses_.adopt(index, places);
  hypotheses_.settle();
}

}  // namespace plumbline::slam
