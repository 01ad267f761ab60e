// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/as_printed/s_graph_localization_paper.h"

#include "bim/digest/digest.h"
#include "slam/localization/wall_matches.h"
#include "slam/particles/pose_clusters.h"

namespace plumbline::slam {

namespace {

/// A storey on which every wall may be seen from everywhere.
StoreyIndex without_visibility(StoreyIndex storey) {
  std::vector<int> all(storey.lines.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  for (std::vector<int>& lines : storey.visible) lines = all;
  return storey;
}

class SGraphLocalizationPaper final : public PlanMethod {
 public:
  SGraphLocalizationPaper(const MethodInput& input, const LocalizationPaperConfig& config)
      : PlanMethod("s_graph_localization_paper", input, config.plan, config.map),
        config_(config),
        filter_(config.filter, config.switches, input, index()) {}

 private:
  [[nodiscard]] PlanBelief update(const PlanScan& scan, Output& output) override;
  void hand_over(const PlanScan& scan, const LocalizationScan& localization_scan,
                 const std::vector<PlaneObservation>& planes);
  [[nodiscard]] PlanBelief searching(const PlanScan& scan) const;

  LocalizationPaperConfig config_;
  PaperFilter filter_;
  std::optional<PlanTracker> tracker_;
  Pose X_OR_last_;
};

PlanBelief SGraphLocalizationPaper::update(const PlanScan& scan, Output& output) {
  Stopwatch stopwatch;
  const std::vector<PlaneObservation> planes =
      ransac_planes(scan.deskewed, config_.ransac, config_.noise, input().seed);  // [shaheer2023, eq. 3]
  const LocalizationScan localization_scan =
      make_localization_scan(scan.deskewed, planes, scan.X_OR, input().calibration, config_.scan);
  record_stage("planes", stopwatch, output);
  if (tracker_) {
    static_cast<void>(tracker_->update(localization_scan, planes));
    record_stage("tracking", stopwatch, output);
  } else {
    filter_.update(scan, planes, X_OR_last_);  // [shaheer2023, eq. 4-9]
    output.digests.push_back({"particles", digest_of(filter_.particles())});
    record_stage("particles", stopwatch, output);
    if (filter_.converged()) hand_over(scan, localization_scan, planes);
  }
  X_OR_last_ = scan.X_OR;
  if (!tracker_) return searching(scan);
  PlanBelief belief;
  belief.state = State::converged;
  belief.X_IR = tracker_->pose(scan.X_OR);
  belief.hypotheses.push_back({1.0, filter_.best().storey, *belief.X_IR, tracker_->covariance(),
                               wall_matches(*input().plan, tracker_->storey(), tracker_->window().back().walls)});
  output.digests.push_back({"tracking", Digest().add(*belief.X_IR).value()});
  return belief;
}

/// The S-Graph's first pose is the best particle's [shaheer2023, eq. 10]; from then on planes are matched against all
/// walls.
void SGraphLocalizationPaper::hand_over(const PlanScan& scan, const LocalizationScan& localization_scan,
                                        const std::vector<PlaneObservation>& planes) {
  const StoreyIndex& storey = index().storeys[static_cast<std::size_t>(filter_.best().storey)];
  TrackerConfig config = config_.tracker;
  const bool printed = config_.switches.handover == PaperVariant::printed;
  if (printed) config.overlap_margin_m = 1e6;  // walls are infinite
  tracker_.emplace(config, printed ? without_visibility(storey) : storey,
                   input().calibration.sensor_height_m - input().calibration.X_RL.t.z());
  tracker_->start(localization_scan, planes, pose_on_floor(filter_.best().storey, filter_.best().X_IH, scan.q_HR));
}

PlanBelief SGraphLocalizationPaper::searching(const PlanScan& scan) const {
  PlanBelief belief;
  belief.particles = filter_.particles();
  const Clustering clustering = find_clusters(belief.particles, {});
  for (const PoseCluster& cluster : clustering.clusters)
    belief.hypotheses.push_back(
        {cluster.mass, cluster.storey, pose_on_floor(cluster.storey, cluster.mean, scan.q_HR), cluster.covariance});
  return belief;
}

}  // namespace

std::unique_ptr<Method> make_s_graph_localization_paper(const MethodInput& input,
                                                        const LocalizationPaperConfig& config) {
  return std::make_unique<SGraphLocalizationPaper>(input, config);
}

}  // namespace plumbline::slam
