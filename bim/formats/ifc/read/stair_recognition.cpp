// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/read/stair_recognition.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "bim/geometry/polygon_boolean.h"

namespace plumbline::bim {
namespace {

/// A face to step on.
struct Tread {
  double z = 0.0;
  Polygon2 outline;  ///< counter-clockwise
  double area_m2 = 0.0;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  bool landing = false;
};

struct LevelFaces {
  double z = 0.0;
  std::vector<Polygon2> triangles;
};

/// Level up-facing triangles by height.
std::vector<LevelFaces> level_faces(const std::vector<Solid>& bodies, const StairRecognitionConfig& config) {
  std::vector<std::pair<double, Polygon2>> faces;
  for (const Solid& body : bodies) {
    for (const Eigen::Vector3i& t : body.triangles) {
      const auto p = [&](int k) { return body.vertices[static_cast<std::size_t>(t[k])]; };
      const Eigen::Vector3d normal = (p(1) - p(0)).cross(p(2) - p(0));
      if (normal.z() <= 0.0 || normal.z() < config.upright * normal.norm()) continue;
      const double z = (p(0).z() + p(1).z() + p(2).z()) / 3.0;
      faces.emplace_back(z, Polygon2{p(0).head<2>(), p(1).head<2>(), p(2).head<2>()});
    }
  }
  std::stable_sort(faces.begin(), faces.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<LevelFaces> levels;
  double last_z = -std::numeric_limits<double>::infinity();
  for (auto& [z, triangle] : faces) {
    if (z - last_z > config.level_m) levels.push_back({z, {}});
    levels.back().triangles.push_back(std::move(triangle));
    last_z = z;
  }
  return levels;
}

/// Shorter and longer side of the smallest rectangle along one of the polygon's edges around it, m; of equal ones the
/// first.
Eigen::Vector2d sides(const Polygon2& polygon) {
  Eigen::Vector2d best(0.0, 0.0);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d edge = polygon[(i + 1) % polygon.size()] - polygon[i];
    const Eigen::Vector2d u = edge.normalized(), v(-u.y(), u.x());
    Eigen::Vector2d low(1e300, 1e300), high(-1e300, -1e300);
    for (const Eigen::Vector2d& p : polygon) {
      low = low.cwiseMin(Eigen::Vector2d(p.dot(u), p.dot(v)));
      high = high.cwiseMax(Eigen::Vector2d(p.dot(u), p.dot(v)));
    }
    const Eigen::Vector2d size = high - low;
    if (size.prod() >= least) continue;
    least = size.prod();
    best = {size.minCoeff(), size.maxCoeff()};
  }
  return best;
}

/// What can be stepped on at each level: its largest piece that no face close above covers.
std::vector<Tread> treads_of(const std::vector<LevelFaces>& levels, const StairRecognitionConfig& config) {
  std::vector<Tread> treads;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    std::vector<Polygon2> above;
    for (std::size_t j = i + 1; j < levels.size() && levels[j].z < levels[i].z + config.headroom_m; ++j)
      above.insert(above.end(), levels[j].triangles.begin(), levels[j].triangles.end());
    Tread tread;
    for (const PolygonWithHoles2& piece : subtract(unite(levels[i].triangles), above)) {
      const double area_m2 = signed_area(piece.outer);
      if (area_m2 > tread.area_m2) tread = {levels[i].z, piece.outer, area_m2, centroid(piece.outer), false};
    }
    if (tread.outline.empty()) continue;
    const Eigen::Vector2d size = sides(tread.outline);
    if (size.x() >= config.least_depth_m && size.y() >= config.least_width_m) treads.push_back(std::move(tread));
  }
  return treads;
}

void mark_landings(std::vector<Tread>& treads, const StairRecognitionConfig& config) {
  if (treads.size() < 3) return;
  std::vector<double> areas;
  for (const Tread& tread : treads) areas.push_back(tread.area_m2);
  std::sort(areas.begin(), areas.end());
  const double median = areas[areas.size() / 2];
  for (Tread& tread : treads) tread.landing = tread.area_m2 > config.landing_runs * median;
}

bool is_step(const Tread& low, const Tread& high, const StairRecognitionConfig& config) {
  return high.z - low.z <= config.most_rise_m;
}

/// Direction of ascent at each tread: from the one before to the one after, landings only where there is no other
/// neighbour.
std::vector<Eigen::Vector2d> directions(const std::vector<Tread>& treads, const StairRecognitionConfig& config) {
  std::vector<Eigen::Vector2d> result;
  for (std::size_t i = 0; i < treads.size(); ++i) {
    const bool has_before = i > 0 && is_step(treads[i - 1], treads[i], config);
    const bool has_after = i + 1 < treads.size() && is_step(treads[i], treads[i + 1], config);
    const bool before_is_tread = has_before && !treads[i - 1].landing;
    const bool after_is_tread = has_after && !treads[i + 1].landing;
    const bool any_tread = before_is_tread || after_is_tread;
    const Tread& from = (any_tread ? before_is_tread : has_before) ? treads[i - 1] : treads[i];
    const Tread& to = (any_tread ? after_is_tread : has_after) ? treads[i + 1] : treads[i];
    const Eigen::Vector2d way = to.middle - from.middle;
    result.push_back(way.norm() > 0.0 ? Eigen::Vector2d(way.normalized()) : Eigen::Vector2d::Zero());
  }
  return result;
}

double angle_between(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return std::abs(std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b)));
}

/// Direction square to the longest edge of a tread that runs across `way`; `way` itself when none does.
Eigen::Vector2d square_to_edge(const Tread& tread, const Eigen::Vector2d& way, const StairRecognitionConfig& config) {
  Eigen::Vector2d best = way;
  double longest = config.least_width_m;
  for (std::size_t i = 0; i < tread.outline.size(); ++i) {
    const Eigen::Vector2d edge = tread.outline[(i + 1) % tread.outline.size()] - tread.outline[i];
    Eigen::Vector2d normal = Eigen::Vector2d(edge.y(), -edge.x()).normalized();
    if (normal.dot(way) < 0.0) normal = -normal;
    if (edge.norm() <= longest || angle_between(normal, way) > config.turn_rad) continue;
    longest = edge.norm();
    best = normal;
  }
  return best;
}

struct Span {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
};

Span span_along(const Polygon2& polygon, const Eigen::Vector2d& u) {
  Span span;
  for (const Eigen::Vector2d& p : polygon) {
    span.low = std::min(span.low, p.dot(u));
    span.high = std::max(span.high, p.dot(u));
  }
  return span;
}

/// Treads [first, last) as one flight; `below` is the level under the first.
StairFlight flight_of(const std::vector<Tread>& treads, std::size_t first, std::size_t last, double below,
                      const Eigen::Vector2d& way, const StairRecognitionConfig& config) {
  const std::size_t n = last - first;
  const Tread& middle = treads[first + n / 2];
  const Eigen::Vector2d u = square_to_edge(middle, way, config), v(-u.y(), u.x());
  const Span foot = span_along(treads[first].outline, u), head = span_along(treads[last - 1].outline, u);
  const Span across = span_along(middle.outline, v);
  StairFlight flight;
  flight.steps = static_cast<int>(n);
  flight.run_m = n > 1 ? (head.low - foot.low) / static_cast<double>(n - 1) : foot.high - foot.low;
  flight.rise_m = n > 1 ? (treads[last - 1].z - treads[first].z) / static_cast<double>(n - 1) : treads[first].z - below;
  flight.z0_m = snap(treads[first].z - flight.rise_m, config.grid_m);
  flight.width_m = snap(across.high - across.low, config.grid_m);
  flight.run_m = snap(flight.run_m, config.step_grid_m);
  flight.rise_m = snap(flight.rise_m, config.step_grid_m);
  flight.yaw = std::atan2(u.y(), u.x()) + 0.0;
  const Eigen::Vector2d start = foot.low * u + 0.5 * (across.low + across.high) * v;
  flight.start = {snap(start.x(), config.grid_m), snap(start.y(), config.grid_m)};
  return flight;
}

/// End of the flight that begins at tread `first`.
std::size_t flight_end(const std::vector<Tread>& treads, const std::vector<Eigen::Vector2d>& ways, std::size_t first,
                       const StairRecognitionConfig& config) {
  std::size_t last = first + 1;
  for (; last < treads.size() && !treads[last].landing; ++last) {
    const Eigen::Vector2d step = treads[last].middle - treads[first].middle;
    const double rise = treads[last].z - treads[last - 1].z;
    const double first_rise = treads[first + 1].z - treads[first].z;
    const double sideways = std::abs(ways[first].x() * step.y() - ways[first].y() * step.x());
    const bool ahead = angle_between(ways[first], ways[last]) <= config.turn_rad && sideways <= config.sideways_m;
    if (rise > config.most_rise_m || std::abs(rise - first_rise) > config.rise_slack_m || !ahead) break;
  }
  return last;
}

}  // namespace

RecognizedStair recognize_stair(const std::vector<Solid>& bodies, const StairRecognitionConfig& config) {
  std::vector<Tread> treads = treads_of(level_faces(bodies, config), config);
  mark_landings(treads, config);
  const std::vector<Eigen::Vector2d> ways = directions(treads, config);
  RecognizedStair shape;
  for (std::size_t i = 0; i < treads.size();) {
    if (treads[i].landing || ways[i].isZero(0.0)) {
      if (treads[i].landing) shape.landings.push_back({treads[i].outline, snap(treads[i].z, config.grid_m)});
      ++i;
      continue;
    }
    const std::size_t end = flight_end(treads, ways, i, config);
    // A single step rises as its neighbours do.
    const bool has_before = i > 0 && is_step(treads[i - 1], treads[i], config);
    const double rise =
        has_before ? treads[i].z - treads[i - 1].z : (i + 1 < treads.size() ? treads[i + 1].z - treads[i].z : 0.0);
    shape.flights.push_back(flight_of(treads, i, end, treads[i].z - rise, ways[i], config));
    i = end;
  }
  return shape;
}

}  // namespace plumbline::bim
