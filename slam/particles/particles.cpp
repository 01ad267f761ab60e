// SPDX-License-Identifier: Apache-2.0
#include "slam/particles/particles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "bim/digest/digest.h"
#include "bim/errors.h"
#include "slam/plan_map/beam_blocks.h"
#include "slam/plan_map/wall_blocks.h"

namespace plumbline::slam {

namespace {

struct Box2 {
  Eigen::Vector2d low, high;
};

Box2 bounds(const Polygon2& polygon) {
  Box2 box{polygon[0], polygon[0]};
  for (const Eigen::Vector2d& p : polygon) {
    box.low = box.low.cwiseMin(p);
    box.high = box.high.cwiseMax(p);
  }
  return box;
}

/// Positions in one room: one draw per cell of a square grid, kept where a body fits.
std::vector<Eigen::Vector2d> stratified_positions(const Polygon2& room, double spacing, double clearance,
                                                  const Stream& stream, std::uint64_t tick, std::uint32_t& lane) {
  std::vector<Eigen::Vector2d> positions;
  const Box2 box = bounds(room);
  const int nx = static_cast<int>(std::ceil((box.high.x() - box.low.x()) / spacing));
  const int ny = static_cast<int>(std::ceil((box.high.y() - box.low.y()) / spacing));
  for (int k = 0; k < nx * ny; ++k, ++lane) {
    const Eigen::Vector2d cell(k % nx, k / nx);
    const Eigen::Vector2d jitter(stream.uniform(tick, lane, 0), stream.uniform(tick, lane, 1));
    const Eigen::Vector2d p = box.low + spacing * (cell + jitter);
    if (contains(room, p) && boundary_distance(room, p) >= clearance) positions.push_back(p);
  }
  return positions;
}

/// Yaw at which an observed wall, drawn at random, is parallel to a line of the plan seen from there.
double aligned_yaw(const StoreyIndex& storey, const Eigen::Vector2d& p, const LocalizationScan& scan, double sigma,
                   const Stream& stream, std::uint64_t tick, std::uint32_t lane) {
  const int cell = storey.grid.cell_at(p);
  const double uniform = 2.0 * std::numbers::pi * stream.uniform(tick, lane, 3);
  if (cell < 0 || scan.walls.empty()) return uniform;
  const std::vector<int>& lines = storey.visible[static_cast<std::size_t>(cell)];
  if (lines.empty()) return uniform;
  const auto pick = [&](std::size_t n, std::uint32_t draw) {
    return static_cast<std::size_t>(stream.uniform(tick, lane, draw) * static_cast<double>(n));
  };
  const WallObservation& wall = scan.walls[pick(scan.walls.size(), 4)];
  const WallLine& line = storey.lines[static_cast<std::size_t>(lines[pick(lines.size(), 5)])];
  return line.azimuth - wall.azimuth + sigma * stream.gauss(tick, lane, 6);
}

double draw_yaw(const StoreyIndex& storey, const Eigen::Vector2d& p, const StartPrior& prior,
                const LocalizationScan& scan, const FilterConfig& config, const Stream& stream, std::uint64_t tick,
                std::uint32_t lane) {
  if (prior.yaw_I) return *prior.yaw_I + prior.yaw_sigma * stream.gauss(tick, lane, 2);
  if (stream.uniform(tick, lane, 7) < config.aligned_share)
    return aligned_yaw(storey, p, scan, config.aligned_sigma, stream, tick, lane);
  return 2.0 * std::numbers::pi * stream.uniform(tick, lane, 3);
}

bool walks_through_wall(const StoreyIndex& storey, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                        double body_height) {
  const double length = (to - from).norm();
  const int cell = storey.grid.cell_at(from);
  if (length < 1e-6 || (cell >= 0 && length < storey.grid.clearance(cell))) return false;
  const PlanRay ray{from, (to - from) / length, storey.floor_at(from) + body_height, 0.0};
  return storey.grid.cast(storey.segments, ray, length, cell).segment >= 0;
}

/// Weights and log-likelihoods of particles, four side by side.
class TemperedSize {
 public:
  TemperedSize(const ParticleSet& particles, const std::vector<double>& log_likelihood, double top)
      : weights_((particles.size() + 3) / 4, all(0.0F)), logs_(weights_) {
    for (std::size_t i = 0; i < particles.size(); ++i) {
      weights_[i / 4][i % 4] = static_cast<float>(particles[i].weight * static_cast<double>(particles.size()));
      logs_[i / 4][i % 4] = static_cast<float>(std::max(log_likelihood[i] - top, -1e30));
    }
  }
  /// Effective sample size of w exp(a (l - max l)).
  [[nodiscard]] double at(double a) const {
    constexpr float negligible = -50.0F;
    const Float4 power = all(static_cast<float>(a));
    double sum = 0.0, squares = 0.0;
    for (std::size_t first = 0; first < logs_.size(); first += chunk) {
      Float4 part = all(0.0F), part_squares = all(0.0F);
      for (std::size_t i = first; i < std::min(first + chunk, logs_.size()); ++i) {
        const Float4 exponent = power * logs_[i];
        const Float4 w = choose(exponent < negligible, all(0.0F), weights_[i] * exp_of(exponent));
        part += w;
        part_squares += w * w;
      }
      for (std::size_t k = 0; k < 4; ++k) {
        sum += static_cast<double>(part[k]);
        squares += static_cast<double>(part_squares[k]);
      }
    }
    return squares > 0.0 ? sum * sum / squares : 0.0;
  }

 private:
  static constexpr std::size_t chunk = 64;  // so few summed up in single precision
  std::vector<Float4> weights_, logs_;
};

}  // namespace

ParticleSet sample_initial_particles(const PlanIndex& index, const StartPrior& prior, const LocalizationScan& scan,
                                     const FilterConfig& config, std::uint64_t seed, std::uint64_t tick) {
  const Stream stream(seed, "slam.localize.init");
  const double density = config.density_per_m2 * (prior.yaw_I ? 1.0 : config.unknown_yaw_factor);
  const double wanted = std::min(density * index.free_area(), static_cast<double>(config.max_particles));
  const double spacing = std::sqrt(index.free_area() / wanted);
  ParticleSet particles;
  std::uint32_t lane = 0;
  for (std::size_t s = 0; s < index.storeys.size(); ++s) {
    const StoreyIndex& storey = index.storeys[s];
    for (const LocalRoom& room : storey.rooms) {
      std::uint32_t yaw_lane = lane;
      for (const Eigen::Vector2d& p :
           stratified_positions(room.polygon, spacing, config.wall_clearance_m, stream, tick, lane)) {
        const double yaw = draw_yaw(storey, p, prior, scan, config, stream, tick, yaw_lane++);
        particles.push_back({{p, wrap_angle(yaw)}, static_cast<int>(s), 1.0, -1});
      }
    }
  }
  if (particles.empty()) throw InputError({}, "no room of the plan is large enough for the robot to stand in");
  normalise(particles);
  return particles;
}

void propagate(ParticleSet& particles, const Pose2& u, const PlanIndex& index, const FilterConfig& config,
               std::uint64_t seed, std::uint64_t tick) {
  const Stream stream(seed, "slam.localize.motion");
  const double walked = u.t.norm(), turned = std::abs(u.yaw);
  const double sigma_trans = std::hypot(config.trans_per_m * walked, config.trans_per_rad_m * turned);
  const double sigma_rot = std::hypot(config.rot_per_rad * turned, config.rot_per_m * walked);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    LocalParticle& particle = particles[i];
    const auto lane = static_cast<std::uint32_t>(i);
    const std::array<double, 4> noise = stream.gauss4(tick, lane);
    const Pose2 u_noisy{u.t + sigma_trans * Eigen::Vector2d(noise[0], noise[1]), u.yaw + sigma_rot * noise[2]};
    const Pose2 moved = particle.X_IH * u_noisy;
    const StoreyIndex& storey = index.storeys[static_cast<std::size_t>(particle.storey)];
    if (walks_through_wall(storey, particle.X_IH.t, moved.t, index.config.body_height_m)) particle.weight = 0.0;
    particle.X_IH = moved;
  }
  normalise(particles);
}

Reweighting reweight(ParticleSet& particles, const LocalizationScan& scan, const PlanIndex& index,
                     const LikelihoodConfig& likelihood, const FilterConfig& config) {
  std::vector<BeamBlocks> beams;
  for (const StoreyIndex& storey : index.storeys) beams.emplace_back(storey, scan, config.beam_stride, likelihood);
  const WallBlocks walls(scan, likelihood);
  constexpr double never = -1e300;
  std::vector<double> log_likelihood(particles.size(), never);
  double top = never;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const LocalParticle& particle = particles[i];
    if (particle.weight <= 0.0) continue;
    const StoreyIndex& storey = index.storeys[static_cast<std::size_t>(particle.storey)];
    const SensorPose2 pose(storey, particle.X_IH, scan);
    log_likelihood[i] =
        walls.log_likelihood(storey, pose) + beams[static_cast<std::size_t>(particle.storey)].log_likelihood(pose);
    top = std::max(top, log_likelihood[i]);
  }
  Reweighting result;
  result.temper = temper(particles, log_likelihood, top, config.ess_floor * static_cast<double>(particles.size()));
  for (std::size_t i = 0; i < particles.size(); ++i)
    particles[i].weight *= std::exp(result.temper * (log_likelihood[i] - top));
  normalise(particles);
  result.effective = effective_size(particles);
  return result;
}

double temper(const ParticleSet& particles, const std::vector<double>& log_likelihood, double top, double floor) {
  const TemperedSize size(particles, log_likelihood, top);
  if (size.at(1.0) >= floor) return 1.0;
  double low = 0.0, high = 1.0;
  while (high - low > 1e-3) {
    const double middle = 0.5 * (low + high);
    (size.at(middle) >= floor ? low : high) = middle;
  }
  return std::max(low, 1e-3);
}

double effective_size(const ParticleSet& particles) {
  double squares = 0.0;
  for (const LocalParticle& particle : particles) squares += particle.weight * particle.weight;
  return squares > 0.0 ? 1.0 / squares : 0.0;
}

void normalise(ParticleSet& particles) {
  double sum = 0.0;
  for (const LocalParticle& particle : particles) sum += particle.weight;
  const double equal = 1.0 / static_cast<double>(particles.size());
  for (LocalParticle& particle : particles) particle.weight = sum > 0.0 ? particle.weight / sum : equal;
}

std::uint64_t digest_of(const ParticleSet& particles) {
  Digest digest;
  for (const LocalParticle& p : particles) digest.add(p.X_IH.t).add(p.X_IH.yaw).add(p.weight).add(p.storey);
  return digest.value();
}

}  // namespace plumbline::slam
