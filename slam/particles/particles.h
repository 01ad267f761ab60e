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
  double density_per_m2 = 30.0;
  double unknown_yaw_factor = 3.0;
  int min_particles = 600;
  int max_particles = 20000;
  double wall_clearance_m = 0.25;
  double aligned_share = 0.5;
  double aligned_sigma = 0.05;

  double trans_per_m = 0.05;
  double trans_per_rad_m = 0.02;
  double rot_per_rad = 0.04;
  double rot_per_m = 0.01;

  int beam_stride = 6;
  double ess_floor = 0.1;
  double ess_resample = 0.5;
  double kld_error = 0.05;
  double kld_quantile = 3.0;
  double rough_scale = 0.25;
  double rough_min_m = 0.01;
  double rough_max_m = 0.10;
  double rough_min_rad = 0.003;
  double rough_max_rad = 0.05;
  int quota = 120;

  template <class V>
  void visit(V& v) {
    v("density_per_m2", density_per_m2,
      Field{.doc = "particles per area at the start when yaw is known", .unit = "1/m²", .min = 0.1});
    v("unknown_yaw_factor", unknown_yaw_factor, plain_field("factor on their number when yaw is unknown", {.min = 0}));
    v("min_particles", min_particles,
      Field{.doc = "lower limit of the number of particles", .min = 10, .max = 1000000, .basic = true});
    v("max_particles", max_particles,
      Field{.doc = "upper limit of the number of particles", .min = 10, .max = 1000000, .basic = true});
    v("wall_clearance_m", wall_clearance_m,
      Field{.doc = "least distance of a start from a room's outline: the robot has a body", .min = 0});
    v("aligned_share", aligned_share,
      share_field("share drawn with an observed wall parallel to a planned one, when yaw is unknown"));
    v("aligned_sigma", aligned_sigma, Field{.doc = "standard deviation of their yaw", .unit = "rad", .min = 1e-6});
    // Leg odometry is 0.5 to 7 % off.
    v("trans_per_m", trans_per_m,
      Field{.doc = "standard deviation of translation per metre walked", .unit = "m/m", .min = 0});
    v("trans_per_rad_m", trans_per_rad_m,
      Field{.doc = "standard deviation of translation per radian turned", .unit = "m/rad", .min = 0});
    v("rot_per_rad", rot_per_rad,
      Field{.doc = "standard deviation of rotation per radian turned", .unit = "rad/rad", .min = 0});
    v("rot_per_m", rot_per_m,
      Field{.doc = "standard deviation of rotation per metre walked", .unit = "rad/m", .min = 0});
    v("beam_stride", beam_stride,
      Field{.doc = "every how many beams the particles use one; hypotheses use all", .min = 1});
    v("ess_floor", ess_floor, share_field("effective share of the particles that tempering keeps in one update"));
    v("ess_resample", ess_resample, share_field("effective share of the particles below which they are resampled"));
    // [fox2001]
    v("kld_error", kld_error,
      plain_field("largest error of the distribution that KLD sampling allows", {.min = 0.001}));
    // 99.9 %
    v("kld_quantile", kld_quantile,
      plain_field("normal quantile of the probability that the error stays below kld_error", {.min = 0.1}));
    v("rough_scale", rough_scale,
      plain_field("roughening after resampling, in standard deviations of the cluster", {.min = 0}));
    v("rough_min_m", rough_min_m, Field{.doc = "least roughening of the position", .min = 0});
    v("rough_max_m", rough_max_m, Field{.doc = "largest roughening of the position", .min = 0});
    v("rough_min_rad", rough_min_rad, Field{.doc = "least roughening of the yaw", .min = 0});
    v("rough_max_rad", rough_max_rad, Field{.doc = "largest roughening of the yaw", .min = 0});
    v("quota", quota,
      Field{.doc = "least number of particles of a cluster that stands for a hypothesis", .min = 1, .max = 100000});
  }
};

/// A yaw that is expected in I, rad.
struct ExpectedYaw {
  double yaw_I, sigma;
};

/// Prior of the pose before any observation, in I.
struct StartPrior {
  std::optional<double> yaw_I;
  double yaw_sigma = 0.05;
  std::optional<ExpectedYaw> doubted_yaw = {};  ///< rules no pose out, see HypothesisSet::expect_yaw
};

/// Uniform over the rooms of the storeys in use, stratified; yaw from the prior, else uniform together with yaws at
/// which an observed wall is parallel to one of the plan. Weights equal.
[[nodiscard]] ParticleSet sample_initial_particles(const PlanIndex& index, const StartPrior& prior,
                                                   const LocalizationScan& scan, const FilterConfig& config,
                                                   std::uint64_t seed, std::uint64_t tick);

/// x_t ~ p(x_t | x_{t-1}, u) [shaheer2023, eq. 4] with u = X_{t-1}^-1 X_t [shaheer2023, eq. 5, order corrected]. A
/// particle that walks through a wall gets weight 0.
void propagate(ParticleSet& particles, const Pose2& u, const PlanIndex& index, const FilterConfig& config,
               std::uint64_t seed, std::uint64_t tick);

/// What one reweighting did.
struct Reweighting {
  double temper = 1.0;     ///< exponent the likelihood was raised to
  double effective = 0.0;  ///< sample size after it
};
/// w <- w p(scan | x)^a, a in (0, 1] the largest that leaves ess_floor N effective particles.
[[nodiscard]] Reweighting reweight(ParticleSet& particles, const LocalizationScan& scan, const PlanIndex& index,
                                   const LikelihoodConfig& likelihood, const FilterConfig& config);

/// Largest a, from 1e-3 to 1, for which the weights w exp(a (log_likelihood - top)) leave so many effective particles;
/// by bisection to 1e-3. top: the largest of them.
[[nodiscard]] double temper(const ParticleSet& particles, const std::vector<double>& log_likelihood, double top,
                            double floor);

/// 1 / sum w^2.
[[nodiscard]] double effective_size(const ParticleSet& particles);
/// Scales weights to sum 1; all equal when they sum to 0.
void normalise(ParticleSet& particles);
[[nodiscard]] std::uint64_t digest_of(const ParticleSet& particles);

}  // namespace plumbline::slam
