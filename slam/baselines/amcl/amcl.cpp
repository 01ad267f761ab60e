// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/amcl/amcl.h"

#include "slam/baselines/amcl/amcl_convergence.h"

namespace plumbline::slam {

namespace {

class Amcl final : public PlanMethod {
 public:
  Amcl(const MethodInput& input, const AmclConfig& config)
      : PlanMethod("amcl", input, config.plan, config.map),
        config_(config),
        filter_(config.filter, config.field, index(), input.seed),
        convergence_(config.filter) {
    clusters_.bin_m = config.filter.bin_m;
    clusters_.yaw_bins = config.filter.yaw_bins;
    clusters_.bin_share = 0.0;
  }

 private:
  [[nodiscard]] PlanBelief update(const PlanScan& scan, Output& output) override;
  [[nodiscard]] PlanBelief belief(const PlanScan& scan);

  AmclConfig config_;
  AmclFilter filter_;
  AmclConvergence convergence_;
  PoseClusterConfig clusters_;
  bool has_seen_ = false;
};

PlanBelief Amcl::update(const PlanScan& scan, Output& output) {
  Stopwatch stopwatch;
  const ScanSlice slice = cut_scan(scan.deskewed, scan.q_HR, input().calibration.sensor_height_m, config_.slice);
  record_stage("slice", stopwatch, output);
  if (!filter_.started())
    filter_.start(scan.prior_yaw_I, scan.prior_yaw_sigma, scan.tick);
  else
    filter_.predict(scan.u, scan.tick);
  filter_.update_weights(slice);
  has_seen_ = has_seen_ || !slice.ends_H.empty();
  output.digests.push_back({"likelihood", digest_of(filter_.particles())});
  record_stage("likelihood", stopwatch, output);
  if (scan.tick % static_cast<std::uint64_t>(config_.filter.resample_interval) == 0) filter_.resample(scan.tick);
  PlanBelief belief_now = belief(scan);
  output.digests.push_back({"resample", digest_of(belief_now.particles)});
  record_stage("resample", stopwatch, output);
  return belief_now;
}

PlanBelief Amcl::belief(const PlanScan& scan) {
  PlanBelief belief;
  belief.particles = filter_.particles();
  const Clustering clustering = find_clusters(belief.particles, clusters_);
  for (const PoseCluster& cluster : clustering.clusters)
    belief.hypotheses.push_back(
        {cluster.mass, cluster.storey, pose_on_floor(cluster.storey, cluster.mean, scan.q_HR), cluster.covariance});
  if (has_seen_) convergence_.update(belief.particles, clustering, scan.u);
  if (!convergence_.converged()) return belief;
  belief.state = State::converged;
  belief.hypotheses.front().covariance = moments_of(belief.particles).covariance;
  belief.X_IR = belief.hypotheses.front().X_IR;
  return belief;
}

}  // namespace

AmclTunedConfig::AmclTunedConfig() {
  filter.alpha1 = 0.05;
  filter.alpha2 = 0.01;
  filter.alpha3 = 0.02;
  filter.alpha4 = 0.02;
  filter.min_particles = 2000;
  filter.max_particles = 20000;
  filter.pf_z = 3.0;
}

std::unique_ptr<Method> make_amcl(const MethodInput& input, const AmclConfig& config) {
  return std::make_unique<Amcl>(input, config);
}

}  // namespace plumbline::slam
