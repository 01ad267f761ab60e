// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "bim/config/visit.h"
#include "slam/particles/particles.h"
#include "slam/plan_map/likelihood_field.h"
#include "slam/scan/scan_slice.h"

namespace plumbline::slam {

/// likelihood_field: p = 1 + sum of pz^3, very flat; likelihood_field_prob: p = product of pz.
enum class BeamModel { likelihood_field, likelihood_field_prob };
[[nodiscard]] constexpr std::array<std::string_view, 2> names_of(BeamModel) {
  return {"likelihood_field", "likelihood_field_prob"};
}
/// What counts as one answer. particles: nav2's own flag, every one within converged_m of the mean in x and in y.
/// covariance: standard deviations of the whole set in x and in y of at most converged_sigma_m. cluster: the heaviest
/// cluster, whose mean nav2 publishes, has nearly all of the mass and such deviations itself.
enum class ConvergedBy { particles, covariance, cluster };
[[nodiscard]] constexpr std::array<std::string_view, 3> names_of(ConvergedBy) {
  return {"particles", "covariance", "cluster"};
}

/// Defaults: those of nav2's node [amcl2026]. nav2 has no state, so what makes one here is assumed.
struct AmclFilterConfig {
  double alpha1 = 0.2;
  double alpha2 = 0.2;
  double alpha3 = 0.2;
  double alpha4 = 0.2;
  BeamModel model = BeamModel::likelihood_field;
  int max_beams = 60;
  double z_hit = 0.5;
  double z_rand = 0.5;
  double sigma_hit_m = 0.2;
  double range_max_m = 100.0;
  int min_particles = 500;
  int max_particles = 2000;
  double pf_err = 0.05;
  double pf_z = 0.99;
  double recovery_alpha_slow = 0.0;
  double recovery_alpha_fast = 0.0;
  int resample_interval = 1;
  double bin_m = 0.5;
  int yaw_bins = 36;
  ConvergedBy converged_by = ConvergedBy::cluster;
  double converged_m = 0.5;
  double converged_sigma_m = 0.5;
  double converged_mass = 0.95;
  double given_up_mass = 0.8;

  template <class V>
  void visit(V& v) {
    v("alpha1", alpha1, plain_field("variance of rotation per squared rotation", {.min = 0, .basic = true}));
    v("alpha2", alpha2,
      Field{.doc = "variance of rotation per squared translation", .unit = "rad²/m²", .min = 0, .basic = true});
    v("alpha3", alpha3, plain_field("variance of translation per squared translation", {.min = 0, .basic = true}));
    v("alpha4", alpha4,
      Field{.doc = "variance of translation per squared rotation", .unit = "m²/rad²", .min = 0, .basic = true});
    v("model", model,
      Field{.doc = "weight of a scan: 1 + the sum of pz³ as nav2's default has it, or the product of all pz"});
    v("max_beams", max_beams,
      Field{.doc = "beams used of a scan, evenly spread", .min = 2, .max = 100000, .basic = true});
    v("z_hit", z_hit, share_field("weight of the Gaussian part of a beam's likelihood", {.basic = true}));
    v("z_rand", z_rand, share_field("weight of the uniform part of a beam's likelihood", {.basic = true}));
    v("sigma_hit_m", sigma_hit_m, Field{.doc = "standard deviation of the Gaussian part", .min = 1e-3, .basic = true});
    v("range_max_m", range_max_m, Field{.doc = "range over which the uniform part is spread", .min = 0.1});
    v("min_particles", min_particles,
      Field{.doc = "lower limit of the number of particles", .min = 1, .max = 1000000, .basic = true});
    v("max_particles", max_particles,
      Field{.doc = "upper limit of the number of particles, and their number at the start",
            .min = 1,
            .max = 1000000,
            .basic = true});
    v("pf_err", pf_err, plain_field("largest error of the distribution that KLD sampling allows", {.min = 1e-3}));
    v("pf_z", pf_z,
      plain_field("normal quantile of the probability that the error stays below pf_err; 0.99 means 84 %", {.min = 0}));
    v("recovery_alpha_slow", recovery_alpha_slow,
      share_field("decay rate of the slow average of the weights, for recovery; 0: no recovery", {.basic = true}));
    v("recovery_alpha_fast", recovery_alpha_fast,
      share_field("decay rate of the fast average of the weights, for recovery; 0: no recovery", {.basic = true}));
    v("resample_interval", resample_interval, Field{.doc = "updates between two resamplings", .min = 1});
    v("bin_m", bin_m, Field{.doc = "bin size of the histogram that KLD sampling counts", .min = 0.05});
    v("yaw_bins", yaw_bins, Field{.doc = "yaw bins of a full turn in that histogram", .min = 4, .max = 3600});
    v("converged_by", converged_by,
      Field{.doc = "convergence test: nav2's own flag, which the other defaults never raise, the covariance of all "
                   "particles, or the heaviest cluster"});
    v("converged_m", converged_m,
      Field{.doc = "largest distance of any particle from the mean, in x and in y, that counts as converged",
            .min = 0});
    v("converged_sigma_m", converged_sigma_m,
      Field{.doc = "largest standard deviation in x and in y that counts as converged; assumed", .min = 0});
    v("converged_mass", converged_mass,
      share_field("least mass of the heaviest cluster that counts as converged; assumed"));
    v("given_up_mass", given_up_mass, share_field("mass of that cluster below which it is given up again; assumed"));
  }
};

/// Number of particles for k occupied bins [fox2001], between the least and the most; the most for one bin.
[[nodiscard]] int kld_limit(int occupied_bins, const AmclFilterConfig& config);

/// The particle filter of AMCL on the slices of a plan. Draws are addressed by (tick, particle), so that they depend on
/// nothing else.
class AmclFilter {
 public:
  /// Throws InputError when no room has space to stand in.
  AmclFilter(const AmclFilterConfig& config, const LikelihoodFieldConfig& field, const PlanIndex& index,
             std::uint64_t seed);

  /// Uniform over free space and yaw; a prior yaw is drawn from its Gaussian instead.
  void start(std::optional<double> yaw_I, double yaw_sigma, std::uint64_t tick);
  /// Differential motion: turn, walk, turn.
  void predict(const Pose2& u, std::uint64_t tick);
  /// Nothing without beams.
  void update_weights(const ScanSlice& slice);
  void resample(std::uint64_t tick);

  [[nodiscard]] bool started() const { return !particles_.empty(); }
  [[nodiscard]] const ParticleSet& particles() const { return particles_; }
  /// Share of uniform poses that the next resampling draws [thrun2005, section 8.3.3].
  [[nodiscard]] double random_share() const;
  /// Likelihood of a slice at a pose; 1 without beams.
  [[nodiscard]] double likelihood(int storey, const Pose2& X_IH, const ScanSlice& slice) const;
  [[nodiscard]] const LikelihoodField& field(int storey) const { return fields_[static_cast<std::size_t>(storey)]; }

 private:
  [[nodiscard]] LocalParticle sample_uniform(const Stream& stream, std::uint64_t tick, std::uint32_t lane) const;

  AmclFilterConfig config_;
  std::uint64_t seed_;
  std::vector<LikelihoodField> fields_;  ///< by storey
  ParticleSet particles_;
  std::optional<double> yaw_I_;
  double yaw_sigma_ = 0.0;
  double w_slow_ = 0.0, w_fast_ = 0.0;
};

}  // namespace plumbline::slam
