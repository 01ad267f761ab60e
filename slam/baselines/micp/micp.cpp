// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/micp/micp.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bim/digest/digest.h"
#include "bim/median.h"

namespace plumbline::slam {

namespace {

constexpr double pi = std::numbers::pi;
constexpr int min_bins = 8;    // of a level profile that is compared
constexpr int min_beams = 40;  // of a scan that is used

struct Track {
  int storey = 0;
  Pose X_IR;
  double inliers = 0.0;
  double evidence = 0.0;  ///< log-likelihood; only differences mean something
  Pose correction;        ///< from where odometry put the robot at the last scan to where the beams did
};

/// A start and the mean error of the level ranges there.
struct Start {
  double mean_error = 0.0;
  int storey = 0;
  Pose2 X_IH;
};

bool near(const Track& a, const Track& b, double gap_m, double gap_rad) {
  const Pose2 A = heading(a.X_IR), B = heading(b.X_IR);
  return a.storey == b.storey && (A.t - B.t).norm() < gap_m && std::abs(wrap_angle(A.yaw - B.yaw)) < gap_rad;
}

class Micp final : public PlanMethod {
 public:
  Micp(const MethodInput& input, const MicpConfig& config);

 private:
  [[nodiscard]] PlanBelief update(const PlanScan& scan, Output& output) override;
  void start(const PlanScan& scan, const MeshBeams& beams);
  [[nodiscard]] std::vector<float> profile(const PlanScan& scan) const;
  [[nodiscard]] std::vector<Start> starts(const PlanScan& scan) const;
  void score_yaws(int storey, const Eigen::Vector2d& p_I, const PlanScan& scan, const std::vector<float>& seen,
                  std::vector<Start>& starts) const;
  void track_hypotheses(const PlanScan& scan, const MeshBeams& beams);
  void prune_and_merge();
  [[nodiscard]] PlanBelief belief() const;

  MicpConfig config_;
  std::vector<MeshCorrector> correctors_;  ///< by storey
  std::vector<Track> tracks_;              ///< best first
  Pose X_OR_last_;
  bool was_single_ = false;
  int bad_scans_ = 0;
};

Micp::Micp(const MethodInput& input, const MicpConfig& config)
    : PlanMethod("micp", input, config.plan, config.map), config_(config) {
  for (const StoreyIndex& storey : index().storeys) correctors_.emplace_back(storey, config.correct);
}

/// Level ranges in yaw_steps bins of azimuth in H, the median of each; 0: nothing seen there.
std::vector<float> Micp::profile(const PlanScan& scan) const {
  const ScanSlice slice = cut_scan(scan.deskewed, scan.q_HR, input().calibration.sensor_height_m, config_.slice);
  const auto bins = static_cast<std::size_t>(config_.yaw_steps);
  std::vector<std::vector<float>> ranges(bins);
  for (const Eigen::Vector2d& end_H : slice.ends_H) {
    const Eigen::Vector2d ray = end_H - slice.sensor_H;
    const double turn = std::atan2(ray.y(), ray.x()) / (2.0 * pi) * config_.yaw_steps;
    const long bin = (std::lround(turn) + config_.yaw_steps) % config_.yaw_steps;
    ranges[static_cast<std::size_t>(bin)].push_back(static_cast<float>(ray.norm()));
  }
  std::vector<float> middle(bins, 0.0F);
  for (std::size_t b = 0; b < bins; ++b) {
    if (ranges[b].empty()) continue;
    middle[b] = upper_median(std::move(ranges[b]));
  }
  return middle;
}

/// Adds every yaw at one position with its mean range error.
void Micp::score_yaws(int storey, const Eigen::Vector2d& p_I, const PlanScan& scan, const std::vector<float>& seen,
                      std::vector<Start>& starts) const {
  const double height =
      index().storeys[static_cast<std::size_t>(storey)].floor_at(p_I) + input().calibration.sensor_height_m;
  const std::vector<float> ranges =
      correctors_[static_cast<std::size_t>(storey)].range_profile({p_I.x(), p_I.y(), height}, config_.yaw_steps);
  constexpr float cap_m = 1.0F;
  for (int shift = 0; shift < config_.yaw_steps; ++shift) {
    const double yaw = wrap_angle(2.0 * pi * shift / config_.yaw_steps);
    const double tolerance = 3.0 * scan.prior_yaw_sigma + 2.0 * pi / config_.yaw_steps;
    if (scan.prior_yaw_I && std::abs(wrap_angle(yaw - *scan.prior_yaw_I)) > tolerance) continue;
    double mean_error = 0.0;
    int count = 0;
    for (int b = 0; b < config_.yaw_steps; ++b) {
      const float range = seen[static_cast<std::size_t>(b)];
      if (range <= 0.0F) continue;
      const float there = ranges[static_cast<std::size_t>((b + shift) % config_.yaw_steps)];
      mean_error += static_cast<double>(std::min(std::abs(there - range), cap_m));
      ++count;
    }
    starts.push_back({mean_error / std::max(count, 1), storey, {p_I, yaw}});
  }
}

/// Every position of a grid over the rooms with every yaw, best first (ties: in the order of the grid).
std::vector<Start> Micp::starts(const PlanScan& scan) const {
  const std::vector<float> seen = profile(scan);
  std::vector<Start> starts;
  if (std::count_if(seen.begin(), seen.end(), [](float range) { return range > 0.0F; }) < min_bins) return starts;
  for (std::size_t s = 0; s < index().storeys.size(); ++s)
    for (const LocalRoom& room : index().storeys[s].rooms) {
      Eigen::Vector2d low = room.polygon.front(), high = low;
      for (const Eigen::Vector2d& p : room.polygon) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
      for (double y = low.y() + 0.5 * config_.grid_m; y < high.y(); y += config_.grid_m)
        for (double x = low.x() + 0.5 * config_.grid_m; x < high.x(); x += config_.grid_m)
          if (contains(room.polygon, {x, y})) score_yaws(static_cast<int>(s), {x, y}, scan, seen, starts);
    }
  std::stable_sort(starts.begin(), starts.end(),
                   [](const Start& a, const Start& b) { return a.mean_error < b.mean_error; });
  return starts;
}

void Micp::start(const PlanScan& scan, const MeshBeams& beams) {
  std::vector<Track> first;
  if (config_.start.given) {
    const MicpStart& given = config_.start;
    const Pose2 X_WH{{given.x_m, given.y_m}, wrap_angle(given.yaw_deg * pi / 180.0)};
    first.push_back({0, pose_on_floor(0, heading(index().X_WI).inverse() * X_WH, scan.q_HR), 0.0, 0.0, {}});
  } else {
    for (const Start& start : starts(scan)) {
      const Track track{start.storey, pose_on_floor(start.storey, start.X_IH, scan.q_HR), 0.0, 0.0, {}};
      const auto same = [&](const Track& other) { return near(track, other, config_.gap_m, config_.gap_rad); };
      if (std::none_of(first.begin(), first.end(), same)) first.push_back(track);
      if (static_cast<int>(first.size()) >= 2 * config_.candidates) break;
    }
  }
  for (Track& track : first) {
    const MeshCorrection correction = correctors_[static_cast<std::size_t>(track.storey)].correct(
        beams, track.X_IR, config_.start_casts, config_.correct.max_distance_m);
    track = {track.storey, correction.X_IR, correction.inliers, -config_.evidence_rays * correction.cost,
             track.X_IR.inverse() * correction.X_IR};
  }
  tracks_ = std::move(first);
  prune_and_merge();
  if (static_cast<int>(tracks_.size()) > config_.candidates)
    tracks_.resize(static_cast<std::size_t>(config_.candidates));
}

void Micp::track_hypotheses(const PlanScan& scan, const MeshBeams& beams) {
  const Pose u = X_OR_last_.inverse() * scan.X_OR;
  for (Track& track : tracks_) {
    track.X_IR = track.X_IR * u;
    track.correction = {};
    if (static_cast<int>(beams.ends_R.size()) < min_beams) {
      track.inliers = 0.0;
      continue;
    }
    const MeshCorrection correction = correctors_[static_cast<std::size_t>(track.storey)].correct(
        beams, track.X_IR, config_.casts, config_.track_distance_m);
    track.correction = track.X_IR.inverse() * correction.X_IR;
    track.X_IR = correction.X_IR;
    track.inliers = correction.inliers;
    track.evidence -= config_.evidence_rays * correction.cost;
  }
  prune_and_merge();
}

/// Orders by evidence, drops the unlikely, and of tracks that have converged to one pose keeps the better one.
void Micp::prune_and_merge() {
  std::stable_sort(tracks_.begin(), tracks_.end(),
                   [](const Track& a, const Track& b) { return a.evidence > b.evidence; });
  std::vector<Track> kept;
  for (const Track& track : tracks_) {
    const auto same = [&](const Track& other) {
      return near(track, other, 0.5 * config_.gap_m, 0.5 * config_.gap_rad);
    };
    const bool hopeless = !kept.empty() && track.evidence < kept.front().evidence - config_.drop_ratio;
    if (!hopeless && std::none_of(kept.begin(), kept.end(), same)) kept.push_back(track);
  }
  tracks_ = std::move(kept);
}

PlanBelief Micp::belief() const {
  PlanBelief belief;
  if (tracks_.empty()) return belief;
  double sum = 0.0;
  for (const Track& track : tracks_) sum += std::exp(track.evidence - tracks_.front().evidence);
  for (const Track& track : tracks_)
    belief.hypotheses.push_back({std::exp(track.evidence - tracks_.front().evidence) / sum, track.storey, track.X_IR,
                                 micp_covariance(track.correction, track.inliers, config_.pose_noise)});
  belief.state = bad_scans_ >= config_.lost_updates ? State::lost : was_single_ ? State::converged : State::ambiguous;
  if (was_single_) belief.X_IR = tracks_.front().X_IR;
  return belief;
}

PlanBelief Micp::update(const PlanScan& scan, Output& output) {
  Stopwatch stopwatch;
  const MeshBeams beams = pick_beams(scan.deskewed, config_.correct);
  if (!tracks_.empty())
    track_hypotheses(scan, beams);
  else if (static_cast<int>(beams.ends_R.size()) >= min_beams)
    start(scan, beams);
  X_OR_last_ = scan.X_OR;
  if (!tracks_.empty()) bad_scans_ = tracks_.front().inliers < config_.lost_inliers ? bad_scans_ + 1 : 0;
  was_single_ = was_single_ || (tracks_.size() == 1 && bad_scans_ == 0);
  Digest digest;
  for (const Track& track : tracks_) digest.add(track.X_IR).add(track.evidence);
  output.digests.push_back({"correction", digest.value()});
  record_stage("correction", stopwatch, output);
  return belief();
}

}  // namespace

Eigen::Matrix3d micp_covariance(const Pose& correction, double inliers, double pose_noise) {
  const double progress = std::exp(-10.0 * correction.t.norm()) * correction.q.w() * correction.q.w() * inliers;
  const double variance = 1.0 - progress + pose_noise;
  return Eigen::Vector3d(variance, variance, 0.25 * variance).asDiagonal();
}

std::unique_ptr<Method> make_micp(const MethodInput& input, const MicpConfig& config) {
  return std::make_unique<Micp>(input, config);
}

}  // namespace plumbline::slam
