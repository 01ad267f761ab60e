// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "bim/config/visit.h"
#include "bim/random/stream.h"
#include "slam/plan_map/likelihood.h"
#include "slam/plan_map/localization_scan.h"
#include "slam/plan_map/plan_index.h"

namespace plumbline::slam {

/// A guess of the robot's pose on one storey; frame I.
struct LocalParticle {
  Pose2 X_IH;
  int storey = 0;       ///< index into PlanIndex::storeys
  double weight = 0.0;  ///< normalised over the set
  int cluster = -1;     ///< label of the last clustering, -1 none
};
using ParticleSet = std::vector<LocalParticle>;

struct FilterConfig {
  double density_per_m2 = 30.0;     ///< at the start, yaw known [facts: 20-40]
  double unknown_yaw_factor = 3.0;  ///< more particles when yaw is unknown
  int min_particles = 600;
  int max_particles = 20000;
  double wall_clearance_m = 0.25;  ///< of the start from a room's outline: the robot has a body
  double aligned_share = 0.5;      ///< yaw unknown: share drawn so that an observed wall is parallel to a planned one
  double aligned_sigma = 0.05;     ///< rad, of those

  double trans_per_m = 0.05;      ///< sigma of translation per metre walked; leg odometry is 0.5-7 % off
  double trans_per_rad_m = 0.02;  ///< m per rad turned
  double rot_per_rad = 0.04;      ///< sigma of rotation per radian turned
  double rot_per_m = 0.01;        ///< rad per metre walked

  int beam_stride = 6;        ///< particles meet every 6th beam of the view, hypotheses all
  double ess_floor = 0.1;     ///< share of N that tempering keeps effective in one update
  double ess_resample = 0.5;  ///< share of N below which the set is drawn again
  double kld_error = 0.05;    ///< Fox 2001
  double kld_quantile = 3.0;  ///< normal quantile of 99.9 %
  double rough_scale = 0.25;  ///< roughening after resampling, of the cluster's standard deviation
  double rough_min_m = 0.01;
  double rough_max_m = 0.10;
  double rough_min_rad = 0.003;
  double rough_max_rad = 0.05;
  int quota = 120;  ///< least particles of a cluster that stands for a hypothesis

  template <class V>
  void visit(V& v) {
    v("density_per_m2", density_per_m2, Field{.doc = "at the start, yaw known", .min = 0.1});
    v("unknown_yaw_factor", unknown_yaw_factor, Field{.doc = "more particles when yaw is unknown", .min = 0});
    v("min_particles", min_particles, Field{.min = 10, .max = 1000000});
    v("max_particles", max_particles, Field{.min = 10, .max = 1000000});
    v("wall_clearance_m", wall_clearance_m,
      Field{.doc = "of the start from a room's outline: the robot has a body", .min = 0});
    v("aligned_share", aligned_share,
      Field{
          .doc = "yaw unknown: share drawn so that an observed wall is parallel to a planned one", .min = 0, .max = 1});
    v("aligned_sigma", aligned_sigma, Field{.doc = "rad, of those", .min = 1e-6});
    v("trans_per_m", trans_per_m,
      Field{.doc = "sigma of translation per metre walked; leg odometry is 0.5-7 % off", .min = 0});
    v("trans_per_rad_m", trans_per_rad_m, Field{.doc = "m per rad turned", .min = 0});
    v("rot_per_rad", rot_per_rad, Field{.doc = "sigma of rotation per radian turned", .min = 0});
    v("rot_per_m", rot_per_m, Field{.doc = "rad per metre walked", .min = 0});
    v("beam_stride", beam_stride, Field{.doc = "particles meet every 6th beam of the view, hypotheses all", .min = 1});
    v("ess_floor", ess_floor,
      Field{.doc = "share of N that tempering keeps effective in one update", .min = 0, .max = 1});
    v("ess_resample", ess_resample, Field{.doc = "share of N below which the set is drawn again", .min = 0, .max = 1});
    v("kld_error", kld_error,
      Field{.doc = "of the distribution, which sets the number of particles (Fox 2001)", .min = 0.001});
    v("kld_quantile", kld_quantile, Field{.doc = "normal quantile of 99.9 %", .min = 0.1});
    v("rough_scale", rough_scale,
      Field{.doc = "roughening after resampling, of the cluster's standard deviation", .min = 0});
    v("rough_min_m", rough_min_m, Field{.min = 0});
    v("rough_max_m", rough_max_m, Field{.min = 0});
    v("rough_min_rad", rough_min_rad, Field{.min = 0});
    v("rough_max_rad", rough_max_rad, Field{.min = 0});
    v("quota", quota,
      Field{.doc = "least particles of a cluster that stands for a hypothesis", .min = 1, .max = 100000});
  }
};

/// What is told of the pose before anything is seen, in I.
struct StartBelief {
  std::optional<double> yaw_I;
  double yaw_sigma = 0.05;
};

/// Uniform over the rooms of the storeys in use, stratified; yaw as told, else uniform together with yaws at which an
/// observed wall is parallel to one of the plan. Weights equal.
[[nodiscard]] ParticleSet draw_start(const PlanIndex& index, const StartBelief& belief, const View& view,
                                     const FilterConfig& config, std::uint64_t seed, std::uint64_t tick);

/// x_t ~ p(x_t | x_{t-1}, u) [BIM-Loc eq. 4] with u = X_{t-1}^-1 X_t [eq. 5, the right way round]. A particle that
/// walks through a wall gets weight 0.
void propagate(ParticleSet& particles, const Pose2& u, const PlanIndex& index, const FilterConfig& config,
               std::uint64_t seed, std::uint64_t tick);

/// What one reweighting did.
struct Reweighting {
  double temper = 1.0;     ///< exponent the likelihood was raised to
  double effective = 0.0;  ///< sample size after it
};
/// w <- w p(view | x)^a, a in (0, 1] the largest that leaves ess_floor N effective particles.
[[nodiscard]] Reweighting reweight(ParticleSet& particles, const View& view, const PlanIndex& index,
                                   const LikelihoodConfig& likelihood, const FilterConfig& config);

/// Largest a, from 1e-3 to 1, for which the weights w exp(a (log_likelihood - top)) leave so many effective particles;
/// by bisection to 1e-3. top: the largest of them.
[[nodiscard]] double temper(const ParticleSet& particles, const std::vector<double>& log_likelihood, double top,
                            double floor);

/// 1 / sum w^2.
[[nodiscard]] double effective_size(const ParticleSet& particles);
/// Scales weights to sum 1; all equal when they sum to 0.
void normalise(ParticleSet& particles);

}  // namespace plumbline::slam
