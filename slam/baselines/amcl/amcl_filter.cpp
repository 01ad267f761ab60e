// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/amcl/amcl_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "bim/errors.h"
#include "slam/particles/pose_clusters.h"

namespace plumbline::slam {

namespace {

constexpr double pi = std::numbers::pi;

/// A turn counts by how far it is from going straight on or straight back.
double turn_noise(double turn) { return std::min(std::abs(turn), std::abs(wrap_angle(turn - pi))); }

using Bin = std::array<int, 4>;

Bin bin_of(const LocalParticle& particle, const AmclFilterConfig& config) {
  const auto cell = [&](double v) { return static_cast<int>(std::floor(v / config.bin_m)); };
  const double turn = (particle.X_IH.yaw + pi) / (2.0 * pi);
  return {particle.storey, cell(particle.X_IH.t.x()), cell(particle.X_IH.t.y()),
          static_cast<int>(turn * config.yaw_bins) % config.yaw_bins};
}

}  // namespace

int kld_limit(int occupied_bins, const AmclFilterConfig& config) {
  if (occupied_bins <= 1) return config.max_particles;
  const double n = std::ceil(kld_bound(occupied_bins, config.pf_err, config.pf_z));
  return static_cast<int>(std::clamp(n, static_cast<double>(std::min(config.min_particles, config.max_particles)),
                                     static_cast<double>(config.max_particles)));
}

AmclFilter::AmclFilter(const AmclFilterConfig& config, const LikelihoodFieldConfig& field, const PlanIndex& index,
                       std::uint64_t seed)
    : config_(config), seed_(seed) {
  std::size_t free = 0;
  for (const StoreyIndex& storey : index.storeys) {
    fields_.emplace_back(storey, field);
    free += fields_.back().free_cells().size();
  }
  if (free == 0) throw InputError({}, "no room of the plan is large enough for the robot to stand in");
}

LocalParticle AmclFilter::sample_uniform(const Stream& stream, std::uint64_t tick, std::uint32_t lane) const {
  std::size_t total = 0;
  for (const LikelihoodField& field : fields_) total += field.free_cells().size();
  auto cell = static_cast<std::size_t>(stream.uniform(tick, lane, 0) * static_cast<double>(total));
  LocalParticle particle;
  while (cell >= fields_[static_cast<std::size_t>(particle.storey)].free_cells().size())
    cell -= fields_[static_cast<std::size_t>(particle.storey++)].free_cells().size();
  const LikelihoodField& field = fields_[static_cast<std::size_t>(particle.storey)];
  const Eigen::Vector2d jitter(stream.uniform(tick, lane, 1) - 0.5, stream.uniform(tick, lane, 2) - 0.5);
  particle.X_IH.t = field.free_cells()[cell].cast<double>() + field.frame().cell * jitter;
  particle.X_IH.yaw = yaw_I_ ? wrap_angle(*yaw_I_ + yaw_sigma_ * stream.gauss(tick, lane, 3))
                             : wrap_angle(2.0 * pi * stream.uniform(tick, lane, 3));
  return particle;
}

void AmclFilter::start(std::optional<double> yaw_I, double yaw_sigma, std::uint64_t tick) {
  yaw_I_ = yaw_I;
  yaw_sigma_ = yaw_sigma;
  const Stream stream(seed_, "slam.localize.init");
  particles_.clear();
  for (int i = 0; i < config_.max_particles; ++i)
    particles_.push_back(sample_uniform(stream, tick, static_cast<std::uint32_t>(i)));
  normalise(particles_);
}

void AmclFilter::predict(const Pose2& u, std::uint64_t tick) {
  const Stream stream(seed_, "slam.localize.motion");
  const double walked = u.t.norm();
  const double turn1 = walked < 0.01 ? 0.0 : std::atan2(u.t.y(), u.t.x());
  const double turn2 = wrap_angle(u.yaw - turn1);
  const double noise1 = turn_noise(turn1), noise2 = turn_noise(turn2);
  const double sigma1 = std::sqrt(config_.alpha1 * noise1 * noise1 + config_.alpha2 * walked * walked);
  const double sigma2 = std::sqrt(config_.alpha1 * noise2 * noise2 + config_.alpha2 * walked * walked);
  const double sigma =
      std::sqrt(config_.alpha3 * walked * walked + config_.alpha4 * (noise1 * noise1 + noise2 * noise2));
  if (yaw_I_) yaw_I_ = wrap_angle(*yaw_I_ + u.yaw);
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const auto lane = static_cast<std::uint32_t>(i);
    Pose2& X = particles_[i].X_IH;
    const double heading = X.yaw + turn1 - sigma1 * stream.gauss(tick, lane, 0);
    const double way = walked - sigma * stream.gauss(tick, lane, 1);
    X.t += way * Eigen::Vector2d(std::cos(heading), std::sin(heading));
    X.yaw = wrap_angle(heading + turn2 - sigma2 * stream.gauss(tick, lane, 2));
  }
}

double AmclFilter::likelihood(int storey, const Pose2& X_IH, const ScanSlice& slice) const {
  const LikelihoodField& field = fields_[static_cast<std::size_t>(storey)];
  const auto beams = slice.ends_H.size();
  const std::size_t step = std::max<std::size_t>(
      1, (beams - std::min<std::size_t>(beams, 1)) / static_cast<std::size_t>(config_.max_beams - 1));
  const double narrow = -0.5 / (config_.sigma_hit_m * config_.sigma_hit_m);
  const double uniform = config_.z_rand / config_.range_max_m;
  const Eigen::Matrix2d R = X_IH.rotation();
  double sum = 1.0, log_product = 0.0;
  for (std::size_t i = 0; i < beams; i += step) {
    const double z = field.at(R * slice.ends_H[i] + X_IH.t);
    const double pz = config_.z_hit * std::exp(narrow * z * z) + uniform;
    sum += pz * pz * pz;
    log_product += std::log(pz);
  }
  return config_.model == BeamModel::likelihood_field ? sum : std::exp(log_product);
}

void AmclFilter::update_weights(const ScanSlice& slice) {
  if (slice.ends_H.empty()) return;
  double mean = 0.0;
  for (LocalParticle& particle : particles_) {
    particle.weight *= likelihood(particle.storey, particle.X_IH, slice);
    mean += particle.weight;
  }
  normalise(particles_);
  // Averages of what the set as a whole explains, before it is normalised away.
  w_slow_ = w_slow_ == 0.0 ? mean : w_slow_ + config_.recovery_alpha_slow * (mean - w_slow_);
  w_fast_ = w_fast_ == 0.0 ? mean : w_fast_ + config_.recovery_alpha_fast * (mean - w_fast_);
}

double AmclFilter::random_share() const { return w_slow_ > 0.0 ? std::max(0.0, 1.0 - w_fast_ / w_slow_) : 0.0; }

void AmclFilter::resample(std::uint64_t tick) {
  const Stream stream(seed_, "slam.localize.resample"), recover(seed_, "slam.localize.recover");
  std::vector<double> reached;
  double sum = 0.0;
  for (const LocalParticle& particle : particles_) reached.push_back(sum += particle.weight);
  const double random = random_share();
  ParticleSet drawn;
  std::set<Bin> bins;
  for (std::uint32_t lane = 0; static_cast<int>(drawn.size()) < config_.max_particles; ++lane) {
    if (random > 0.0 && recover.uniform(tick, lane, 7) < random) {
      drawn.push_back(sample_uniform(recover, tick, lane));
    } else {
      const double target = stream.uniform(tick, lane) * sum;
      const auto it = std::upper_bound(reached.begin(), reached.end() - 1, target);
      drawn.push_back(particles_[static_cast<std::size_t>(it - reached.begin())]);
    }
    bins.insert(bin_of(drawn.back(), config_));
    if (static_cast<int>(drawn.size()) > kld_limit(static_cast<int>(bins.size()), config_)) break;
  }
  if (random > 0.0) w_slow_ = w_fast_ = 0.0;
  for (LocalParticle& particle : drawn) particle.weight = 1.0;
  normalise(drawn);
  particles_ = std::move(drawn);
}

}  // namespace plumbline::slam
