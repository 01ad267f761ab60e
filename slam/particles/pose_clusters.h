// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "bim/config/visit.h"
#include "slam/particles/particles.h"

namespace plumbline::slam {

struct PoseClusterConfig {
  double bin_m = 0.5;
  int yaw_bins = 36;
  double bin_share = 0.01;
  double compact_m = 0.40;
  double compact_rad = 0.20;

  template <class V>
  void visit(V& v) {
    // [amcl2026]
    v("bin_m", bin_m, Field{.doc = "bin size of the histogram of positions", .min = 0.05});
    v("yaw_bins", yaw_bins, Field{.doc = "yaw bins of a full turn", .min = 4, .max = 3600});
    v("bin_share", bin_share,
      share_field("mass, as a share of the heaviest bin's, below which a bin joins no cluster"));
    v("compact_m", compact_m,
      Field{.doc = "standard deviation of the position per axis below which a cluster is one pose", .min = 0});
    v("compact_rad", compact_rad,
      Field{.doc = "standard deviation of the yaw below which a cluster is one pose", .min = 0});
  }
};

/// Particles in bins that touch (also diagonally, yaw wrapped).
struct PoseCluster {
  int storey = 0;
  double mass = 0.0;
  Pose2 mean;                                            ///< X_IH; yaw is the circular mean
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of (x, y, yaw) in I
  int count = 0;
  bool compact = false;
};

struct Clustering {
  std::vector<PoseCluster> clusters;  ///< by mass, ties by lowest bin
  int occupied_bins = 0;              ///< that belong to a cluster
};

/// Groups particles and writes each one's label (-1: in no group).
[[nodiscard]] Clustering find_clusters(ParticleSet& particles, const PoseClusterConfig& config);

/// Number of particles for k occupied bins [fox2001].
[[nodiscard]] int kld_size(int occupied_bins, const FilterConfig& config);
/// The same without bounds, for at least two bins: error is the Kullback-Leibler distance, quantile the normal's.
[[nodiscard]] double kld_bound(int occupied_bins, double error, double quantile);

/// Draws `count` particles by systematic resampling inside each cluster. A cluster gets its share of the count, but at
/// least the quota, while its mass stays the same; so poses that look alike survive until an observation separates
/// them. Then roughens by the cluster's own spread.
[[nodiscard]] ParticleSet resample(const ParticleSet& particles, const Clustering& clustering, int count, int quota,
                                   const FilterConfig& config, std::uint64_t seed, std::uint64_t tick);

}  // namespace plumbline::slam
