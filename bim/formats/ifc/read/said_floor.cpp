// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/read/said_floor.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "bim/geometry/polygon.h"
#include "bim/model/hull.h"

namespace plumbline::bim {
namespace {

double sum(const std::vector<WeighedHeight>& heights) {
  double all = 0.0;
  for (const WeighedHeight& height : heights) all += height.weight;
  return all;
}

/// Weight of the heights from low to high.
double between(const std::vector<WeighedHeight>& heights, double low_m, double high_m) {
  double in = 0.0;
  for (const WeighedHeight& height : heights)
    if (height.z_m >= low_m && height.z_m <= high_m) in += height.weight;
  return in;
}

double near(const std::vector<WeighedHeight>& heights, double z_m, double tolerance_m) {
  return between(heights, z_m - tolerance_m, z_m + tolerance_m);
}

/// The level with most weight around it, and in that the height with most weight; of equal ones the lowest.
WeighedHeight largest_level(const std::vector<WeighedHeight>& heights, double window_m) {
  constexpr double same_m = 1e-3;
  std::map<std::int64_t, WeighedHeight> steps;  // heights this close are one
  for (const WeighedHeight& height : heights) {
    WeighedHeight& step =
        steps.try_emplace(std::llround(height.z_m / same_m), WeighedHeight{height.z_m, 0.0}).first->second;
    step.weight += height.weight;
  }
  std::vector<WeighedHeight> distinct;
  for (const auto& [place, step] : steps) distinct.push_back(step);
  WeighedHeight level{0.0, -1.0};
  double at_height = 0.0;
  for (const WeighedHeight& step : distinct) {
    const double weight = near(distinct, step.z_m, window_m);
    const double rounding = 1e-9 * weight;  // of a sum in another order
    if (weight < level.weight - rounding || (weight <= level.weight + rounding && step.weight <= at_height + rounding))
      continue;
    level = {step.z_m, weight};
    at_height = step.weight;
  }
  return level;
}

/// Whether most of the walls or of the spaces begin far below.
bool is_over_head(const FloorHints& hints, double z_m, double under_m) {
  const double deepest = -std::numeric_limits<double>::infinity();
  const auto most = [&](const std::vector<WeighedHeight>& feet) {
    return !feet.empty() && between(feet, deepest, z_m - under_m) > 0.5 * sum(feet);
  };
  return most(hints.walls) || most(hints.spaces);
}

}  // namespace

double foot_of(const StepProduct& product) {
  double foot = std::numeric_limits<double>::infinity();
  for (const Shape& shape : product.body)
    for (const Eigen::Vector3d& p : shape.base.points) foot = std::min(foot, (product.X_WP * p).z());
  return foot;
}

double top_of(const StepProduct& product) {
  double top = -std::numeric_limits<double>::infinity();
  for (const Shape& shape : product.body)
    for (const Eigen::Vector3d& p : shape.base.points) top = std::max(top, (product.X_WP * p).z());
  return top;
}

void add_hints(const StepProduct& product, double storey_m, FloorHints& hints) {
  constexpr double steepest = 0.40;  // a steeper face is no floor
  const double foot = foot_of(product);
  if (!std::isfinite(foot)) return;
  Polygon2 corners;
  for (const Shape& shape : product.body)
    for (const Eigen::Vector3d& p : shape.base.points) corners.emplace_back((product.X_WP * p).head<2>());
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : corners) box.extend(p);
  switch (product.kind) {
    case StepClass::wall:
      hints.walls.push_back({foot, box.diagonal().norm()});
      return;
    case StepClass::space:
      if (product.space_use == SpaceUse::room)
        hints.spaces.push_back({foot, std::abs(signed_area(convex_hull(std::move(corners))))});
      return;
    case StepClass::slab:
      break;
    default:
      return;
  }
  double top = foot, all_m2 = 0.0;
  for (const Shape& shape : product.body) {
    std::vector<std::string> problems;
    const Solid solid = placed(product.X_WP, solid_of(shape, problems));
    for (const Eigen::Vector3i& t : solid.triangles) {
      const auto p = [&](int k) -> const Eigen::Vector3d& { return solid.vertices[static_cast<std::size_t>(t[k])]; };
      const Eigen::Vector3d n = (p(1) - p(0)).cross(p(2) - p(0));
      if (!(n.z() > 0.0) || n.head<2>().norm() > steepest * n.z()) continue;
      hints.slabs.push_back({(p(0).z() + p(1).z() + p(2).z()) / 3.0, 0.5 * n.z()});
      all_m2 += 0.5 * n.z();
    }
    for (const Eigen::Vector3d& p : solid.vertices) top = std::max(top, p.z());
  }
  if (all_m2 > 0.0 && foot <= storey_m && storey_m <= top) hints.at_storey.push_back({storey_m, all_m2});
}

std::optional<double> said_floor(const FloorHints& hints, double storey_m, const std::vector<double>& others,
                                 const SaidFloorConfig& config) {
  std::vector<WeighedHeight> floors = hints.spaces;
  for (const WeighedHeight& slab : hints.slabs) {
    const bool own = std::abs(slab.z_m - storey_m) <= config.covering_m;
    if (own || !is_over_head(hints, slab.z_m, config.under_ceiling_m)) floors.push_back(slab);
  }
  const bool by_walls = floors.empty();
  const std::vector<WeighedHeight>& all = by_walls ? hints.walls : floors;
  if (all.empty()) return std::nullopt;
  const WeighedHeight level = largest_level(all, config.window_m);
  const double off_m = std::abs(level.z_m - storey_m);
  if (off_m <= config.same_m || level.weight < config.most_share * sum(all)) return std::nullopt;

  const auto doors = std::count_if(hints.doors.begin(), hints.doors.end(),
                                   [&](double z) { return std::abs(z - storey_m) <= config.window_m; });
  if (2 * static_cast<std::size_t>(doors) >= hints.doors.size() && doors > 0) return std::nullopt;
  const double here = near(all, storey_m, by_walls ? config.with_walls_only_m : config.covering_m) +
                      (by_walls ? 0.0 : sum(hints.at_storey));
  const bool far = off_m > (by_walls ? config.with_walls_only_m : config.covering_m);
  if (far && here >= config.levels_share * level.weight) return std::nullopt;
  // A slab that is a little lower may have a covering; then something else begins at the height of the storey.
  const auto begins_here = [&](const std::vector<WeighedHeight>& feet) {
    return near(feet, storey_m, config.same_m) > 0.0;
  };
  if (!far && (by_walls || !hints.at_storey.empty() || begins_here(floors) || begins_here(hints.walls)))
    return std::nullopt;
  const bool slabs_alone =
      near(hints.spaces, level.z_m, config.window_m) <= 0.0 && near(hints.walls, level.z_m, config.covering_m) <= 0.0;
  const bool taken = std::any_of(others.begin(), others.end(),
                                 [&](double other) { return std::abs(other - level.z_m) <= config.apart_m; });
  if (slabs_alone && taken) return std::nullopt;
  return level.z_m;
}

}  // namespace plumbline::bim
