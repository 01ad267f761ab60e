// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/proposals.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace plumbline::slam {

namespace {

bool lies_on(const WallObservation& wall, const WallLine& line, const Eigen::Vector2d& sensor_I,
             const LikelihoodConfig& config) {
  const double foot = line.e.dot(sensor_I - line.a), margin = config.overlap_margin_m;
  const double overlap = std::min(foot + wall.s1, line.length + margin) - std::max(foot + wall.s0, -margin);
  return overlap >= config.overlap_min * (wall.s1 - wall.s0);
}

/// A wall of a storey or a row of planned furniture.
struct Front {
  const WallLine* line = nullptr;
  int wall = -1;  ///< in StoreyIndex::lines, -1: a row
};

/// Those long enough for such a patch: walls, then rows.
std::vector<Front> fronts_for(const WallObservation& patch, const StoreyIndex& storey, const LikelihoodConfig& config) {
  const double least_m = config.overlap_min * (patch.s1 - patch.s0) - 2.0 * config.overlap_margin_m;
  std::vector<Front> fronts;
  for (const std::vector<WallLine>* lines : {&storey.lines, &storey.rows})
    for (const WallLine& line : *lines)
      if (line.length >= least_m)
        fronts.push_back({&line, lines == &storey.lines ? static_cast<int>(&line - lines->data()) : -1});
  return fronts;
}

/// The pose from which patch u is front a and patch v is front b, where it lies in a room and walls among them are
/// visible.
std::optional<Pose2> pose_at(const StoreyIndex& storey, const LocalizationScan& scan, const WallObservation& u,
                             const Front& a, const WallObservation& v, const Front& b,
                             const LikelihoodConfig& likelihood) {
  const WallLine &line_a = *a.line, &line_b = *b.line;
  Eigen::Matrix2d N;
  N << line_a.n.transpose(), line_b.n.transpose();
  const Eigen::Vector2d sensor_I = N.inverse() * Eigen::Vector2d(u.distance - line_a.d, v.distance - line_b.d);
  const int cell = storey.grid.cell_at(sensor_I);
  if (cell < 0 || !lies_on(u, line_a, sensor_I, likelihood) || !lies_on(v, line_b, sensor_I, likelihood))
    return std::nullopt;
  const std::vector<int>& visible = storey.visible[static_cast<std::size_t>(cell)];
  const auto is_visible = [&](const Front& front) {
    return front.wall < 0 || std::binary_search(visible.begin(), visible.end(), front.wall);
  };
  if (!is_visible(a) || !is_visible(b)) return std::nullopt;
  const double yaw_a = line_a.azimuth - u.azimuth, yaw_b = line_b.azimuth - v.azimuth;
  Pose2 X_IH{{}, wrap_angle(yaw_a + 0.5 * wrap_angle(yaw_b - yaw_a))};
  X_IH.t = sensor_I - X_IH.rotation() * scan.sensor_H;
  if (storey.room_at(X_IH.t) < 0) return std::nullopt;
  return X_IH;
}

}  // namespace

std::vector<StoreyPose> non_max_suppression(std::vector<ScoredPose> poses, int count, double gap_m, double gap_rad) {
  std::stable_sort(poses.begin(), poses.end(),
                   [](const ScoredPose& a, const ScoredPose& b) { return a.score > b.score; });
  std::vector<StoreyPose> best;
  for (const ScoredPose& scored : poses) {
    if (static_cast<int>(best.size()) >= count) break;
    const StoreyPose& pose = scored.pose;
    const bool apart = std::none_of(best.begin(), best.end(), [&](const StoreyPose& other) {
      return other.storey == pose.storey && is_near(other.X_IH, pose.X_IH, gap_m, gap_rad);
    });
    if (apart) best.push_back(pose);
  }
  return best;
}

std::vector<StoreyPose> propose_poses(const PlanIndex& index, const StartPrior& prior, const LocalizationScan& scan,
                                      int beam_stride, const LikelihoodConfig& likelihood,
                                      const ProposalConfig& config) {
  std::vector<ScoredPose> by_walls, by_rows;
  const std::size_t walls = std::min(scan.walls.size(), static_cast<std::size_t>(config.walls));
  for (std::size_t s = 0; s < index.storeys.size(); ++s) {
    const StoreyIndex& storey = index.storeys[s];
    std::vector<std::vector<Front>> fronts;
    for (std::size_t i = 0; i < walls; ++i) fronts.push_back(fronts_for(scan.walls[i], storey, likelihood));
    for (std::size_t i = 0; i < walls; ++i)
      for (std::size_t j = i + 1; j < walls; ++j) {
        const WallObservation &u = scan.walls[i], &v = scan.walls[j];
        const double corner = wrap_angle(v.azimuth - u.azimuth);
        if (std::abs(std::sin(corner)) < config.corner_min_sin) continue;
        for (const Front& a : fronts[i]) {
          const double azimuth = a.line->azimuth;
          if (prior.yaw_I && std::abs(wrap_angle(azimuth - u.azimuth - *prior.yaw_I)) > config.yaw_tolerance) continue;
          for (const Front& b : fronts[j]) {
            const double turn = b.line->azimuth - azimuth;
            if (std::abs(wrap_angle(turn - corner)) > config.angle_tolerance) continue;
            if (const auto X_IH = pose_at(storey, scan, u, a, v, b, likelihood))
              (a.wall < 0 || b.wall < 0 ? by_rows : by_walls)
                  .push_back({{static_cast<int>(s), *X_IH, true},
                              beam_log_likelihood(storey, *X_IH, scan, beam_stride, likelihood)});
          }
        }
      }
  }
  std::vector<StoreyPose> poses = non_max_suppression(std::move(by_walls), config.count, config.gap_m, config.gap_rad);
  for (const StoreyPose& pose : non_max_suppression(std::move(by_rows), config.count, config.gap_m, config.gap_rad))
    poses.push_back(pose);
  return poses;
}

std::vector<std::vector<StoreyPose>> slide_across_walls(const PlanIndex& index, const StoreyPose& pose,
                                                        const LocalizationScan& scan, int beam_stride,
                                                        const LikelihoodConfig& likelihood,
                                                        const ProposalConfig& config) {
  const StoreyIndex& storey = index.storeys[static_cast<std::size_t>(pose.storey)];
  std::vector<double> normals;  // azimuths in I
  std::vector<std::vector<StoreyPose>> slid;
  const std::size_t walls = std::min(scan.walls.size(), static_cast<std::size_t>(config.walls));
  for (std::size_t i = 0; i < walls; ++i) {
    const double normal = pose.X_IH.yaw + scan.walls[i].azimuth;
    const auto is_parallel = [&](double other) { return std::abs(std::sin(other - normal)) < config.angle_tolerance; };
    if (std::any_of(normals.begin(), normals.end(), is_parallel)) continue;
    normals.push_back(normal);
    const Eigen::Vector2d step = config.slide_step_m * Eigen::Vector2d(std::cos(normal), std::sin(normal));
    std::vector<ScoredPose> along;
    const int reach = static_cast<int>(config.slide_m / config.slide_step_m);
    for (int k = -reach; k <= reach; ++k) {
      const StoreyPose moved{pose.storey, {pose.X_IH.t + k * step, pose.X_IH.yaw}};
      if (storey.room_at(moved.X_IH.t) < 0) continue;
      along.push_back({moved, beam_log_likelihood(storey, moved.X_IH, scan, beam_stride, likelihood)});
    }
    slid.push_back(non_max_suppression(std::move(along), config.slide_count, config.gap_m, config.gap_rad));
  }
  return slid;
}

}  // namespace plumbline::slam
