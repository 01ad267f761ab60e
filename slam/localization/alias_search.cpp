// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/alias_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bim/geometry/polygon.h"

namespace plumbline::slam {

namespace {

/// Places of a square grid in the rooms of a storey.
std::vector<Eigen::Vector2d> places_of(const StoreyIndex& storey, double spacing) {
  Eigen::AlignedBox2d box;
  for (const LocalRoom& room : storey.rooms)
    for (const Eigen::Vector2d& p : room.polygon) box.extend(p);
  std::vector<Eigen::Vector2d> places;
  if (box.isEmpty()) return places;
  for (double y = box.min().y() + 0.5 * spacing; y < box.max().y(); y += spacing)
    for (double x = box.min().x() + 0.5 * spacing; x < box.max().x(); x += spacing)
      if (storey.room_at({x, y}) >= 0) places.emplace_back(x, y);
  return places;
}

/// What the plan predicts at a pose in the place of what a scan measured, beam by beam.
LocalizationScan predicted_scan(const StoreyIndex& storey, const Pose2& X_IH, const LocalizationScan& scan,
                                double range_max) {
  LocalizationScan predicted;
  predicted.sensor_H = scan.sensor_H;
  predicted.sensor_height = scan.sensor_height;
  const Eigen::Matrix2d R_IH = X_IH.rotation();
  const Eigen::Vector2d sensor_I = X_IH * scan.sensor_H;
  std::vector<SensorRay> rays;
  for (const Beam& beam : scan.beams) rays.push_back({R_IH * beam.direction_H, beam.slope});
  std::vector<StructureHit> hits(rays.size());
  storey.structure->cast({sensor_I.x(), sensor_I.y(), storey.floor_at(sensor_I) + scan.sensor_height}, rays, range_max,
                         hits);
  for (std::size_t i = 0; i < hits.size(); ++i)
    if (hits[i].upright) predicted.beams.push_back({scan.beams[i].direction_H, hits[i].distance, scan.beams[i].slope});
  return predicted;
}

struct Edge {
  Eigen::Vector2d a, e;
  double length = 0.0;
};

std::vector<Edge> edges_of(const Polygon2& polygon) {
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d way = polygon[(i + 1) % polygon.size()] - polygon[i];
    if (way.norm() > 0.0) edges.push_back({polygon[i], way.normalized(), way.norm()});
  }
  return edges;
}

/// Whether all corners of a room moved by T lie on the outline of the other.
bool covers(const Polygon2& room, const Pose2& T, const Polygon2& other, double tolerance) {
  return std::all_of(room.begin(), room.end(),
                     [&](const Eigen::Vector2d& p) { return boundary_distance(other, T * p) <= tolerance; });
}

/// Motions that bring the outline of a room onto that of another one, or onto itself by a turn; of a round room, which
/// has many, some.
std::vector<Pose2> motions_onto(const Polygon2& room, const Polygon2& other, double tolerance) {
  constexpr std::size_t most = 8;
  std::vector<Pose2> motions;
  const std::vector<Edge> edges = edges_of(room);
  double around = 0.0;
  for (const Edge& edge : edges) around += edge.length;
  if (std::abs(std::abs(signed_area(room)) - std::abs(signed_area(other))) > tolerance * around) return motions;
  const auto longest =
      std::max_element(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.length < b.length; });
  if (longest == edges.end()) return motions;
  for (const Edge& edge : edges_of(other)) {
    if (std::abs(edge.length - longest->length) > tolerance) continue;
    Pose2 T{{}, wrap_angle(std::atan2(edge.e.y(), edge.e.x()) - std::atan2(longest->e.y(), longest->e.x()))};
    T.t = edge.a - T.rotation() * longest->a;
    if (covers(room, T, other, tolerance)) motions.push_back(T);
    if (motions.size() >= most) break;
  }
  return motions;
}

}  // namespace

AliasSearch::AliasSearch(const PlanIndex& index, double sensor_height, const AliasSearchConfig& config)
    : config_(config), sensor_height_(sensor_height) {
  const double wanted = index.free_area() / (config.spacing_m * config.spacing_m);
  const double spacing = config.spacing_m * std::sqrt(std::max(1.0, wanted / config.max_places));
  for (const StoreyIndex& storey : index.storeys) {
    Places& places = storeys_.emplace_back(Places{places_of(storey, spacing), {}});
    for (const Eigen::Vector2d& p : places.sensor_I) {
      const std::vector<float> ranges = ring(storey, p, 0.0);
      places.ranges.insert(places.ranges.end(), ranges.begin(), ranges.end());
    }
  }
}

std::vector<float> AliasSearch::ring(const StoreyIndex& storey, const Eigen::Vector2d& sensor_I, double yaw) const {
  std::vector<SensorRay> rays;
  for (int k = 0; k < config_.azimuths; ++k) {
    const double angle = yaw + 2.0 * std::numbers::pi * k / config_.azimuths;
    rays.push_back({{std::cos(angle), std::sin(angle)}, 0.0});
  }
  std::vector<StructureHit> hits(rays.size());
  storey.structure->cast({sensor_I.x(), sensor_I.y(), storey.floor_at(sensor_I) + sensor_height_}, rays,
                         config_.range_max_m, hits);
  std::vector<float> ranges;
  for (const StructureHit& hit : hits)
    ranges.push_back(static_cast<float>(hit.element >= 0 ? hit.distance : config_.range_max_m));
  return ranges;
}

std::vector<ScoredPose> AliasSearch::candidates(int storey, const std::vector<float>& wanted, const StartPrior& prior,
                                                const Eigen::Vector2d& sensor_H) const {
  const Places& places = storeys_[static_cast<std::size_t>(storey)];
  const auto n = wanted.size();
  std::vector<float> twice(2 * n);
  const auto cap = static_cast<float>(config_.residual_cap_m);
  const float most = static_cast<float>(config_.max_mean_m) * static_cast<float>(n);
  std::vector<ScoredPose> found;
  for (std::size_t i = 0; i < places.sensor_I.size(); ++i) {
    const auto first = places.ranges.begin() + static_cast<std::ptrdiff_t>(i * n);
    std::copy_n(first, n, twice.begin());
    std::copy_n(first, n, twice.begin() + static_cast<std::ptrdiff_t>(n));
    for (std::size_t shift = 0; shift < n; ++shift) {
      const double yaw = wrap_angle(2.0 * std::numbers::pi * static_cast<double>(shift) / static_cast<double>(n));
      if (prior.yaw_I && std::abs(wrap_angle(yaw - *prior.yaw_I)) > config_.yaw_tolerance) continue;
      float sum = 0.0F;
      for (std::size_t a = 0; a < n; ++a) sum += std::min(std::abs(twice[a + shift] - wanted[a]), cap);
      if (sum > most) continue;
      Pose2 X_IH{{}, yaw};
      X_IH.t = places.sensor_I[i] - X_IH.rotation() * sensor_H;
      found.push_back({{storey, X_IH, true}, -static_cast<double>(sum)});
    }
  }
  return found;
}

std::vector<StoreyPose> AliasSearch::in_rooms_alike(const PlanIndex& index, const StoreyPose& pose,
                                                    const StartPrior& prior) const {
  std::vector<StoreyPose> images;
  const StoreyIndex& own = index.storeys[static_cast<std::size_t>(pose.storey)];
  const int room = own.room_at(pose.X_IH.t);
  if (room < 0) return images;
  for (std::size_t s = 0; s < index.storeys.size(); ++s)
    for (const LocalRoom& other : index.storeys[s].rooms)
      for (const Pose2& T :
           motions_onto(own.rooms[static_cast<std::size_t>(room)].polygon, other.polygon, config_.room_tolerance_m)) {
        const Pose2 X_IH = T * pose.X_IH;
        if (prior.yaw_I && std::abs(wrap_angle(X_IH.yaw - *prior.yaw_I)) > config_.yaw_tolerance) continue;
        if (images.size() < static_cast<std::size_t>(config_.count))
          images.push_back({static_cast<int>(s), X_IH, true});
      }
  return images;
}

std::vector<StoreyPose> AliasSearch::find(const PlanIndex& index, const StoreyPose& pose, const StartPrior& prior,
                                          const LocalizationScan& scan, const LikelihoodConfig& likelihood,
                                          const RefineConfig& refine) const {
  const StoreyIndex& own = index.storeys[static_cast<std::size_t>(pose.storey)];
  const std::vector<float> wanted = ring(own, pose.X_IH * scan.sensor_H, pose.X_IH.yaw);
  const LocalizationScan predicted = predicted_scan(own, pose.X_IH, scan, config_.range_max_m);
  std::vector<ScoredPose> fitted;
  const auto fit = [&](const StoreyPose& candidate) {
    const StoreyIndex& storey = index.storeys[static_cast<std::size_t>(candidate.storey)];
    Pose2 X_IH = candidate.X_IH;
    for (int pass = 0; pass < 2; ++pass) X_IH = slam::refine(storey, X_IH, predicted, likelihood, refine).X_IH;
    if (candidate.storey == pose.storey && is_near(X_IH, pose.X_IH, config_.gap_m, config_.gap_rad)) return;
    const double inliers = agreement(storey, X_IH, predicted, likelihood, refine).inliers;
    if (inliers >= config_.min_inliers) fitted.push_back({{candidate.storey, X_IH, true}, inliers});
  };
  // First, so that they win ties: along a corridor there are many places that look alike.
  for (const StoreyPose& image : in_rooms_alike(index, pose, prior)) fit(image);
  for (int s = 0; s < static_cast<int>(storeys_.size()); ++s)
    for (const StoreyPose& candidate : non_max_suppression(candidates(s, wanted, prior, scan.sensor_H), config_.count,
                                                           config_.gap_m, config_.gap_rad))
      fit(candidate);
  return non_max_suppression(std::move(fitted), config_.count, 0.5 * config_.gap_m, 0.5 * config_.gap_rad);
}

}  // namespace plumbline::slam
