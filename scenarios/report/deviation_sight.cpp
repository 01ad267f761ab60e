// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/deviation_sight.h"

#include <algorithm>
#include <cmath>

#include "scenarios/localizability/floor.h"
#include "scenarios/localizability/range_image.h"

namespace plumbline::scenarios {

namespace {

constexpr double apart_m = 0.03;    ///< less is no deviation that a LiDAR of 1 to 2 cm noise shows
constexpr double outline_m = 0.15;  ///< a beam that ends this near to an outline ends at its element
constexpr int least_beams = 3;

bool ends_at(const Polygon2& outline_W, const Eigen::Vector3d& p_W) {
  if (outline_W.size() < 3) return false;
  const Eigen::Vector2d p = p_W.head<2>();
  return contains(outline_W, p) || boundary_distance(outline_W, p) < outline_m;
}

/// Ends of the beams that end apart, as planned and as built; a beam without an end has none.
struct Ends {
  std::vector<Eigen::Vector3d> planned_W, built_W;
};

Ends ends_apart(const RangeImager& imager, const VisibleBuilding& visible, const SensorPose& place) {
  const RangeImage planned = imager.cast(visible.planned.scene, place);
  const RangeImage built = imager.cast(visible.as_built().scene, place);
  const Pose X = place.pose();
  Ends ends;
  for (std::size_t i = 0; i < built.range_m.size(); ++i) {
    const double p = planned.range_m[i], b = built.range_m[i];
    if (!(std::abs(p - b) > apart_m)) continue;  // both endless: not a number
    if (std::isfinite(p)) ends.planned_W.push_back(X * (p * imager.directions()[i]));
    if (std::isfinite(b)) ends.built_W.push_back(X * (b * imager.directions()[i]));
  }
  return ends;
}

bool in_sight(const ReportDeviation& deviation, const Ends& ends) {
  const auto count = [](const std::vector<Eigen::Vector3d>& points, const Polygon2& outline_W) {
    return std::count_if(points.begin(), points.end(), [&](const auto& p) { return ends_at(outline_W, p); });
  };
  return count(ends.planned_W, deviation.planned_W) + count(ends.built_W, deviation.built_W) >= least_beams;
}

}  // namespace

void set_sights(const RunBuilding& building, const std::vector<TruthSample>& walk,
                std::vector<ReportDeviation>& deviations) {
  const auto drawn = [](const ReportDeviation& d) { return !d.planned_W.empty() || !d.built_W.empty(); };
  if (std::none_of(deviations.begin(), deviations.end(), drawn)) return;
  for (ReportDeviation& deviation : deviations) deviation.judged = drawn(deviation);
  const VisibleBuilding visible = visible_building(building, PlanEvidence::whole_plan);
  const RangeImager imager;
  const TruthSample* last = nullptr;
  for (const TruthSample& sample : walk) {
    if (last != nullptr && (sample.X_WR.t - last->X_WR.t).head<2>().norm() < localizability_constants.step_m) continue;
    last = &sample;
    const SensorPose place{{sample.X_WR.t.x(), sample.X_WR.t.y(), sample.sensor_z_W}, sample.X_WR.yaw()};
    const Ends ends = ends_apart(imager, visible, place);
    for (ReportDeviation& deviation : deviations)
      if (deviation.judged && !deviation.seen_at_s && in_sight(deviation, ends)) deviation.seen_at_s = sample.t_s;
  }
}

}  // namespace plumbline::scenarios
