// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/amcl/amcl_convergence.h"

#include <algorithm>
#include <cmath>

namespace plumbline::slam {

namespace {

/// Farther than this from where it should have moved to, the heaviest cluster is another one.
constexpr double same_cluster_m = 1.0;

bool narrow(const Eigen::Matrix3d& covariance, double sigma_m) {
  return covariance.diagonal().head<2>().maxCoeff() <= sigma_m * sigma_m;
}

}  // namespace

void AmclConvergence::update(const ParticleSet& particles, const Clustering& clustering, const Pose2& u) {
  const bool agrees = !clustering.clusters.empty() &&
                      (config_.converged_by == ConvergedBy::cluster ? cluster_agrees(clustering.clusters.front(), u)
                                                                    : whole_set_agrees(particles));
  if (agrees)
    answer_ = clustering.clusters.front().mean;
  else
    answer_.reset();
}

bool AmclConvergence::cluster_agrees(const PoseCluster& heaviest, const Pose2& u) const {
  const bool kept = answer_ && ((*answer_ * u).t - heaviest.mean.t).norm() <= same_cluster_m;
  return heaviest.mass >= (kept ? config_.given_up_mass : config_.converged_mass) &&
         narrow(heaviest.covariance, config_.converged_sigma_m);
}

bool AmclConvergence::whole_set_agrees(const ParticleSet& particles) const {
  const bool one_storey = std::all_of(particles.begin(), particles.end(), [&](const LocalParticle& particle) {
    return particle.storey == particles.front().storey;
  });
  if (!one_storey) return false;
  const SetMoments moments = moments_of(particles);
  if (config_.converged_by == ConvergedBy::covariance) return narrow(moments.covariance, config_.converged_sigma_m);
  return std::all_of(particles.begin(), particles.end(), [&](const LocalParticle& particle) {
    return (particle.X_IH.t - moments.mean.t).cwiseAbs().maxCoeff() <= config_.converged_m;
  });
}

SetMoments moments_of(const ParticleSet& particles) {
  SetMoments moments;
  double c = 0.0, s = 0.0;
  for (const LocalParticle& particle : particles) {
    moments.mean.t += particle.weight * particle.X_IH.t;
    c += particle.weight * std::cos(particle.X_IH.yaw);
    s += particle.weight * std::sin(particle.X_IH.yaw);
  }
  moments.mean.yaw = std::atan2(s, c);
  for (const LocalParticle& particle : particles) {
    Eigen::Vector3d e;
    e << particle.X_IH.t - moments.mean.t, wrap_angle(particle.X_IH.yaw - moments.mean.yaw);
    moments.covariance += particle.weight * e * e.transpose();
  }
  return moments;
}

}  // namespace plumbline::slam
