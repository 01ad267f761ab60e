// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/global_localizer.h"

#include <utility>

#include "bim/digest/digest.h"

namespace plumbline::slam {

namespace {

std::uint64_t digest_of(const Clustering& clustering) {
  Digest digest;
  for (const PoseCluster& c : clustering.clusters) digest.add(c.mass).add(c.mean.t).add(c.mean.yaw).add(c.count);
  return digest.value();
}

std::uint64_t digest_of(const std::vector<PoseHypothesis>& hypotheses) {
  Digest digest;
  for (const PoseHypothesis& c : hypotheses) digest.add(c.id).add(c.X_IH.t).add(c.X_IH.yaw).add(c.evidence);
  return digest.value();
}

}  // namespace

GlobalLocalizer::GlobalLocalizer(GlobalLocalizerConfig config, std::uint64_t seed)
    : config_(config),
      seed_(seed),
      hypotheses_(config.hypotheses, config.refine, config.likelihood, config.comparison) {}

std::vector<StageDigest> GlobalLocalizer::update(const PlanIndex& index, const StartPrior& start,
                                                 const LocalizationScan& scan) {
  const Pose2 X_OH = heading(scan.X_OR);
  const Pose2 u = last_X_OH_ ? last_X_OH_->inverse() * X_OH : Pose2{};
  last_X_OH_ = X_OH;
  ++tick_;
  std::vector<StageDigest> digests;
  const auto done = [&](const char* stage, std::uint64_t digest) { digests.push_back({stage, digest}); };

  if (particles_.empty())
    particles_ = sample_initial_particles(index, start, scan, config_.filter, seed_, tick_);
  else
    propagate(particles_, u, index, config_.filter, seed_, tick_);  // [shaheer2023, eq. 4-5]
  done("motion", digest_of(particles_));

  const Reweighting weighting =
      reweight(particles_, scan, index, config_.likelihood, config_.filter);  // [shaheer2023, eq. 6-9]
  done("likelihood", digest_of(particles_));

  const Clustering clustering = find_clusters(particles_, config_.clusters);
  done("clusters", digest_of(clustering));

  hypotheses_.expect_yaw(start.doubted_yaw);
  hypotheses_.predict_and_update(index, u, scan);
  const bool first = hypotheses_.all().empty();
  hypotheses_.add(index, clustering);
  hypotheses_.prune_and_normalize();
  // Particles may have died out by chance where the plan repeats itself; search it before the first report.
  since_alternatives_m_ = first ? config_.convergence.alternatives_every_m : since_alternatives_m_ + u.t.norm();
  if (since_alternatives_m_ >= config_.convergence.alternatives_every_m && !hypotheses_.all().empty())
    find_alternatives(index, start, scan);
  update_state(index, start, scan, u.t.norm());
  done("hypotheses", digest_of(hypotheses_.all()));

  if (particles_.empty()) return digests;  // no pose in the plan fits: the next update starts anew
  const int quota = hypotheses_.all().empty() ? 0 : config_.filter.quota;
  hypotheses_.reweight_particles(particles_, clustering, quota, seed_, tick_);
  const double size = static_cast<double>(particles_.size());
  if (weighting.effective < config_.filter.ess_resample * size || quota > 0)
    particles_ = resample(particles_, clustering, kld_size(clustering.occupied_bins, config_.filter), quota,
                          config_.filter, seed_, tick_);
  done("resample", digest_of(particles_));
  return digests;
}

void GlobalLocalizer::restart() {
  particles_.clear();
  hypotheses_.clear();
  last_X_OH_.reset();  // the motion until the next update is no single increment
  state_ = State::searching;
  converged_updates_ = failed_updates_ = 0;
  converged_travel_m_ = 0.0;
}

void GlobalLocalizer::update_state(const PlanIndex& index, const StartPrior& start, const LocalizationScan& scan,
                                   double walked) {
  const ConvergenceConfig& c = config_.convergence;
  const std::vector<PoseHypothesis>& hypotheses = hypotheses_.all();
  state_ = State::searching;
  if (hypotheses.empty()) return;
  const auto best_is_decisive = [&] {
    const PoseHypothesis& best = hypotheses.front();
    return best.mass >= c.top_mass && (hypotheses.size() < 2 || best.evidence - hypotheses[1].evidence >= c.log_ratio);
  };
  if (hypotheses.size() > 1 && !best_is_decisive()) state_ = State::ambiguous;

  const Agreement& fit = hypotheses.front().agreement;
  const auto best_fits = [&] {
    const bool fits_now = fit.inliers >= c.inliers_min && fit.penetration_ratio <= c.max_penetration_ratio;
    return (fits_now || hypotheses.front().fit >= c.min_fit) && hypotheses.front().mean_fit() >= c.min_mean_fit;
  };
  // While it was tracked it may have stood elsewhere.
  if (since_alternatives_m_ == 0.0 && best_is_decisive() && !best_fits()) hypotheses_.replay_best_agreement(index);
  const bool fits = best_fits();
  failed_updates_ = fit.penetration_ratio_otherwise() > c.restart_penetration_ratio ? failed_updates_ + 1 : 0;
  if (failed_updates_ >= c.restart_updates) return restart();

  // Where the plan has no floor the leader says that the robot is outdoors, or that the plan is another building's.
  const auto has_floor = [&] {
    const PoseHypothesis& best = hypotheses.front();
    return index.storeys[static_cast<std::size_t>(best.storey)].has_floor_at(best.X_IH.t);
  };
  const bool decisive = fits && best_is_decisive() && has_floor();
  converged_travel_m_ = decisive && converged_updates_ > 0 ? converged_travel_m_ + walked : 0.0;
  converged_updates_ = decisive ? converged_updates_ + 1 : 0;
  if (converged_updates_ < c.updates || converged_travel_m_ < c.travel_m) return;
  const StoreyPose leader = hypotheses.front().pose();
  find_alternatives(index, start, scan);
  hypotheses_.reassess(index);
  hypotheses_.prune_and_normalize();
  // Another leader has yet to lead for as long: evidence that turns within one scan is none.
  if (!best_is_decisive() || !is_same(hypotheses.front().pose(), leader)) {
    converged_updates_ = 0;
    state_ = State::ambiguous;
    return;
  }
  state_ = State::converged;
}

bool GlobalLocalizer::is_same(const StoreyPose& a, const StoreyPose& b) const {
  return a.storey == b.storey && is_near(a.X_IH, b.X_IH, config_.hypotheses.match_m, config_.hypotheses.match_rad);
}

void GlobalLocalizer::find_alternatives(const PlanIndex& index, const StartPrior& start, const LocalizationScan& scan) {
  since_alternatives_m_ = 0.0;
  StartPrior prior = start;
  if (prior.yaw_I) prior.yaw_I = hypotheses_.all().front().X_IH.yaw;
  ParticleSet sample = sample_initial_particles(index, prior, scan, config_.filter, seed_, tick_);
  FilterConfig untempered = config_.filter;
  untempered.ess_floor = 0.0;
  static_cast<void>(reweight(sample, scan, index, config_.likelihood, untempered));
  std::vector<StoreyPose> poses =
      propose_poses(index, prior, scan, config_.filter.beam_stride, config_.likelihood, config_.proposals);
  std::vector<ScoredPose> scored;
  for (const LocalParticle& particle : sample) scored.push_back({{particle.storey, particle.X_IH}, particle.weight});
  const ConvergenceConfig& c = config_.convergence;
  for (const StoreyPose& pose :
       non_max_suppression(std::move(scored), c.alternatives, c.alternative_gap_m, c.alternative_gap_rad))
    poses.push_back(pose);
  hypotheses_.add(index, poses);
  hypotheses_.prune_and_normalize();
  for (const std::vector<StoreyPose>& slid :
       slide_across_walls(index, hypotheses_.all().front().pose(), scan, config_.filter.beam_stride, config_.likelihood,
                          config_.proposals))
    hypotheses_.add_best(index, slid);
  hypotheses_.prune_and_normalize();
  hypotheses_.add(index, aliases(index, hypotheses_.all().front().pose(), prior, scan));
  hypotheses_.prune_and_normalize();
}

std::vector<StoreyPose> GlobalLocalizer::aliases(const PlanIndex& index, const StoreyPose& pose,
                                                 const StartPrior& prior, const LocalizationScan& scan) {
  if (!alias_search_ || alias_search_->storeys() != index.storeys.size())
    alias_search_.emplace(index, scan.sensor_height, config_.aliases);
  return alias_search_->find(index, pose, prior, scan, config_.likelihood, config_.refine);
}

}  // namespace plumbline::slam
