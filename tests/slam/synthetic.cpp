// SPDX-License-Identifier: Apache-2.0
#include "tests/slam/synthetic.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "bim/random/stream.h"

namespace plumbline::slam::synthetic {

namespace {

constexpr int rings = 16;
constexpr int columns = 1824;
constexpr Nanoseconds firing_period = 55'296;
constexpr Nanoseconds laser_period = 2'304;
constexpr Nanoseconds odometry_period = 10'000'000;
constexpr double azimuth_per_firing = 2.0 * std::numbers::pi * 10.0 * 55.296e-6;  // 600 rpm
constexpr double rad = std::numbers::pi / 180.0;
constexpr double rounding_m = 0.5;  // half the stretch of way over which a corner is averaged
constexpr double base_height_m = 0.46;

/// Wall along x or y with door gaps given by their centres, 1.0 m wide and 2.1 m high.
void add_wall(House& house, const Eigen::Vector2d& min, const Eigen::Vector2d& max, const std::vector<double>& doors) {
  const int axis = max.x() - min.x() > max.y() - min.y() ? 0 : 1;
  double from = min[axis];
  const auto piece = [&](double a, double b, double z0) {
    Box box{{min.x(), min.y(), z0}, {max.x(), max.y(), house.height_m}};
    box.min[axis] = a;
    box.max[axis] = b;
    house.boxes.push_back(box);
  };
  for (const double door : doors) {
    piece(from, door - 0.5, 0.0);
    piece(door - 0.5, door + 0.5, 2.1);
    from = door + 0.5;
  }
  piece(from, max[axis], 0.0);
}

Polygon2 rectangle(double x0, double y0, double x1, double y1) { return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}; }

using Directions = std::array<Eigen::Vector3d, rings>;

/// The boxes that rays from p along these directions may meet: those of which, in plan, a corner lies between the
/// outermost ones or corners lie on both sides.
void keep_ahead(const std::vector<Box>& boxes, const Eigen::Vector3d& p, const Directions& directions,
                std::vector<const Box*>& ahead) {
  constexpr double widest = 0.5, margin = 1e-6;
  const auto cross = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); };
  const Eigen::Vector2d middle = directions[rings / 2].head<2>().normalized();
  double left = 0.0, right = 0.0;  // tangents of the angles to the outermost ones
  for (const Eigen::Vector3d& v : directions) {
    const double forward = middle.dot(v.head<2>());
    if (!(forward > margin)) left = right = 2.0 * widest;
    left = std::max(left, cross(middle, v.head<2>()) / forward);
    right = std::max(right, -cross(middle, v.head<2>()) / forward);
  }
  const bool any = std::max(left, right) > widest;
  const Eigen::Vector2d normal(-middle.y(), middle.x());
  const Eigen::Vector2d leftmost = middle + (left + margin) * normal, rightmost = middle - (right + margin) * normal;
  ahead.clear();
  for (const Box& box : boxes) {
    bool beyond_left = true, beyond_right = true, behind = true;
    for (const double x : {box.min.x(), box.max.x()})
      for (const double y : {box.min.y(), box.max.y()}) {
        const Eigen::Vector2d d(x - p.x(), y - p.y());
        beyond_left = beyond_left && cross(leftmost, d) > 0.0;
        beyond_right = beyond_right && cross(rightmost, d) < 0.0;
        behind = behind && middle.dot(d) < 0.0;
      }
    if (any || !(beyond_left || beyond_right || behind)) ahead.push_back(&box);
  }
}

/// Range from p along the unit direction v to the nearest of these boxes, floor or ceiling, infinity when there is
/// none.
double cast(const std::vector<const Box*>& boxes, double height_m, const Eigen::Vector3d& p, const Eigen::Vector3d& v) {
  double best = std::numeric_limits<double>::infinity();
  if (v.z() < 0.0) best = -p.z() / v.z();
  if (v.z() > 0.0) best = (height_m - p.z()) / v.z();
  const Eigen::Array3d inverse = v.array().inverse();
  for (const Box* box : boxes) {
    const Eigen::Array3d a = (box->min - p).array() * inverse;
    const Eigen::Array3d b = (box->max - p).array() * inverse;
    const double enter = a.min(b).maxCoeff();
    const double leave = a.max(b).minCoeff();
    if (enter > 0.0 && enter <= leave) best = std::min(best, enter);
  }
  return best;
}

Eigen::Vector2d along(const std::vector<Eigen::Vector2d>& way, double s) {
  for (std::size_t i = 0; i + 1 < way.size(); ++i) {
    const double length = (way[i + 1] - way[i]).norm();
    if (s < length || i + 2 == way.size()) return way[i] + (way[i + 1] - way[i]) * (s / length);
    s -= length;
  }
  return way.front();
}

double length(const std::vector<Eigen::Vector2d>& way) {
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < way.size(); ++i) sum += (way[i + 1] - way[i]).norm();
  return sum;
}

/// Laser that fires in slot k of a ring: ring 0 is laser 0, ring 1 laser 2, ..., ring 8 laser 1, ...
int laser_of_ring(int ring) { return ring < 8 ? 2 * ring : 2 * (ring - 8) + 1; }

struct Measured {
  double range_m = 0.0;
};

Measured measure(double range, const WalkConfig& config, const Stream& noise, std::uint64_t firing, int ring) {
  const auto lane = static_cast<std::uint32_t>(ring);
  if (!(range < 100.0) || noise.uniform(firing, lane, 1) < config.dropout) return {};
  const double r = range + config.range_bias_m + config.range_sigma_m * noise.gauss(firing, lane, 0);
  return {std::max(0.0, std::round(r / 0.002) * 0.002)};
}

Scan scan_message(const House& house, const std::function<Pose(double)>& X_WR_at, const WalkConfig& config,
                  std::int64_t message) {
  const Stream noise(config.seed, "bim.generate");
  Scan scan;
  scan.rings = rings;
  scan.columns = columns;
  const auto n = static_cast<std::size_t>(rings * columns);
  scan.range_m.assign(n, 0.0);
  scan.point_L.assign(n, Eigen::Vector3d::Zero());
  scan.reflectivity.assign(n, 50.0F);
  scan.offset_ns.assign(n, 0);
  const Nanoseconds start = message * columns * firing_period;
  scan.stamp = start + (columns - 1) * firing_period + 15 * laser_period;
  const Pose X_RL = calibration().X_RL;
  Directions directions_L, directions_W;
  std::vector<const Box*> ahead;
  for (int column = 0; column < columns; ++column) {
    const Nanoseconds t = start + column * firing_period;
    const auto firing = static_cast<std::uint64_t>(message * columns + column);
    const Pose X_WL = X_WR_at(seconds(t)) * X_RL;
    for (int ring = 0; ring < rings; ++ring) {
      const double azimuth =
          -azimuth_per_firing * (static_cast<double>(firing) + static_cast<double>(laser_of_ring(ring) * laser_period) /
                                                                   static_cast<double>(firing_period));
      const double elevation = (2.0 * ring - 15.0) * rad;
      const auto k = static_cast<std::size_t>(ring);
      directions_L[k] = {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                         std::sin(elevation)};
      directions_W[k] = X_WL.q * directions_L[k];
    }
    keep_ahead(house.boxes, X_WL.t, directions_W, ahead);
    for (int ring = 0; ring < rings; ++ring) {
      const auto k = static_cast<std::size_t>(ring), i = static_cast<std::size_t>(column * rings + ring);
      scan.offset_ns[i] = static_cast<std::int32_t>(t + laser_of_ring(ring) * laser_period - scan.stamp);
      const double range = cast(ahead, house.height_m, X_WL.t, directions_W[k]);
      scan.range_m[i] = measure(range, config, noise, firing, ring).range_m;
      scan.point_L[i] = scan.range_m[i] * directions_L[k];
    }
  }
  return scan;
}

/// Leg odometry at 100 Hz: true increments, scaled, with noise that grows with the way walked. Roll and pitch stay
/// true, since a real robot knows them from gravity.
std::vector<Odometry> reckon(const std::vector<Eigen::Vector2d>& waypoints, const WalkConfig& config,
                             Nanoseconds until) {
  const Stream noise(config.seed, "bim.generate");
  const double root = std::sqrt(config.speed_mps * seconds(odometry_period));
  std::vector<Odometry> records = {{0, Pose{}}};
  const Pose X_WO = walk_pose(waypoints, config, 0.0);
  Pose X_WR_before = X_WO;
  Pose X_OR = {};
  for (Nanoseconds t = odometry_period; t <= until; t += odometry_period) {
    const auto draw = [&](std::uint32_t k) { return noise.gauss(static_cast<std::uint64_t>(t), 100, k); };
    const Pose X_WR = walk_pose(waypoints, config, seconds(t));
    Pose step = X_WR_before.inverse() * X_WR;
    step.t *= config.odometry_scale;
    step.t += config.odometry_sigma * root * Eigen::Vector3d(draw(0), draw(1), draw(2));
    X_OR = X_OR * step;
    const Eigen::Vector3d up_O = X_WO.q.conjugate() * Eigen::Vector3d::UnitZ();
    X_OR.q = (exp_so3(config.odometry_yaw_sigma * root * draw(3) * up_O) * X_OR.q).normalized();
    records.push_back({t, X_OR});
    X_WR_before = X_WR;
  }
  return records;
}

}  // namespace

Calibration calibration() {
  return {.X_RL = {Eigen::Quaterniond::Identity(), {0.0, 0.0, 0.2}}, .sensor_height_m = 0.66};
}

House one_room(double length_m, double width_m) {
  House house;
  add_wall(house, {-0.2, -0.2}, {length_m + 0.2, 0.0}, {});
  add_wall(house, {-0.2, width_m}, {length_m + 0.2, width_m + 0.2}, {});
  add_wall(house, {-0.2, 0.0}, {0.0, width_m}, {});
  add_wall(house, {length_m, 0.0}, {length_m + 0.2, width_m}, {});
  house.rooms = {rectangle(0.0, 0.0, length_m, width_m)};
  return house;
}

House corridor_house() {
  House house;
  add_wall(house, {-0.2, -4.4}, {14.2, -4.2}, {});
  add_wall(house, {-0.2, 6.4}, {14.2, 6.6}, {});
  add_wall(house, {-0.2, -4.2}, {0.0, 6.4}, {});
  add_wall(house, {14.0, -4.2}, {14.2, 6.4}, {});
  add_wall(house, {0.0, 2.2}, {14.0, 2.4}, {2.2, 7.0, 11.5});
  add_wall(house, {0.0, -0.2}, {14.0, 0.0}, {3.5, 10.0});
  add_wall(house, {4.5, 2.4}, {4.7, 6.4}, {});
  add_wall(house, {9.2, 2.4}, {9.4, 6.4}, {});
  add_wall(house, {6.9, -4.2}, {7.1, -0.2}, {});
  house.rooms = {rectangle(0.0, 0.0, 14.0, 2.2), rectangle(0.0, 2.4, 4.5, 6.4),   rectangle(4.7, 2.4, 9.2, 6.4),
                 rectangle(9.4, 2.4, 14.0, 6.4), rectangle(0.0, -4.2, 6.9, -0.2), rectangle(7.1, -4.2, 14.0, -0.2)};
  return house;
}

std::vector<Eigen::Vector2d> corridor_house_walk() {
  return {{1.0, 1.1},  {2.2, 1.2},   {2.2, 3.2},   {1.0, 4.2},   {2.2, 5.4},  {3.4, 4.2},  {2.2, 3.0},  {2.2, 1.1},
          {3.5, 1.0},  {3.5, -1.2},  {1.5, -2.2},  {3.5, -3.3},  {5.5, -2.2}, {3.5, -1.0}, {3.5, 1.1},  {7.0, 1.2},
          {7.0, 3.2},  {5.8, 4.2},   {7.0, 5.4},   {8.2, 4.2},   {7.0, 3.0},  {7.0, 1.1},  {10.0, 1.1}, {10.0, -1.2},
          {8.5, -2.2}, {10.0, -3.3}, {12.0, -2.2}, {10.0, -1.0}, {10.0, 1.1}, {11.5, 1.2}, {11.5, 3.2}, {10.4, 4.2},
          {11.5, 5.4}, {12.8, 4.2},  {11.5, 3.0},  {11.5, 1.1},  {1.0, 1.1}};
}

House two_storeys() {
  constexpr double storey_m = 3.0, slab_m = 0.2, foot_m = 1.0, head_m = 5.2;
  constexpr int steps = 16;
  House house;
  house.height_m = 2.0 * storey_m - slab_m;
  for (const auto& [min, max] : {std::pair(Eigen::Vector2d(-0.2, -2.0), Eigen::Vector2d(6.2, -1.8)),
                                 std::pair(Eigen::Vector2d(-0.2, 4.0), Eigen::Vector2d(6.2, 4.2)),
                                 std::pair(Eigen::Vector2d(-0.2, -1.8), Eigen::Vector2d(0.0, 4.0)),
                                 std::pair(Eigen::Vector2d(6.0, -1.8), Eigen::Vector2d(6.2, 4.0))})
    add_wall(house, min, max, {});
  // The wall with the doors stands on each storey for itself.
  House partition{.boxes = {}, .rooms = {}, .height_m = storey_m - slab_m};
  add_wall(partition, {0.0, -0.2}, {6.0, 0.0}, {0.5, 5.5});
  for (const double floor : {0.0, storey_m})
    for (const Box& box : partition.boxes)
      house.boxes.push_back({box.min + floor * Eigen::Vector3d::UnitZ(), box.max + floor * Eigen::Vector3d::UnitZ()});
  const auto slab = [&](double x0, double y0, double x1, double y1) {
    house.boxes.push_back({{x0, y0, storey_m - slab_m}, {x1, y1, storey_m}});
  };
  slab(0.0, -0.2, 6.0, 4.0);
  slab(0.0, -1.8, foot_m, -0.2);
  slab(head_m, -1.8, 6.0, -0.2);
  for (int k = 0; k < steps; ++k)
    house.boxes.push_back(
        {{foot_m + (head_m - foot_m) * k / steps, -1.8, 0.0}, {head_m, -0.2, storey_m * (k + 1) / steps}});
  for (int storey = 0; storey < 2; ++storey) house.rooms.push_back(rectangle(0.0, 0.0, 6.0, 4.0));
  return house;
}

std::vector<Eigen::Vector2d> two_storeys_walk() {
  return {{3.0, 2.0}, {1.5, 3.0}, {0.5, 1.2}, {0.5, -1.0}, {5.5, -1.0}, {5.5, 1.2}, {4.5, 3.0}, {2.5, 2.0}};
}

double two_storeys_climb(double s) {
  const std::vector<Eigen::Vector2d> way = two_storeys_walk();
  const double foot = length({way.begin(), way.begin() + 4}) + 0.5;  // the flight begins 0.5 m from the turn
  return std::clamp((s - foot) / 4.2, 0.0, 1.0) * 3.0;
}

Pose walk_pose(const std::vector<Eigen::Vector2d>& waypoints, const WalkConfig& config, double t) {
  constexpr int samples = 16;
  const double s = config.speed_mps * t;
  Eigen::Vector2d p = Eigen::Vector2d::Zero();
  for (int k = 0; k < samples; ++k)
    p += along(waypoints, s + rounding_m * ((2.0 * k + 1.0) / samples - 1.0)) / static_cast<double>(samples);
  const Eigen::Vector2d ahead = along(waypoints, s + rounding_m) - along(waypoints, s - rounding_m);

  const double phase = 2.0 * std::numbers::pi * 2.1 * t;
  const double roll = config.vibration * 0.8 * rad * std::sin(0.5 * phase);
  const double pitch = config.vibration * 0.6 * rad * std::sin(phase + 0.7);
  const double bounce = config.vibration * 0.006 * std::sin(phase);
  const double floor = config.climb != nullptr ? config.climb(s) : 0.0;
  Pose X_WR = Pose::from_xyz_yaw({p.x(), p.y(), floor + base_height_m + bounce}, std::atan2(ahead.y(), ahead.x()));
  X_WR.q = (X_WR.q * exp_so3({roll, pitch, 0.0})).normalized();
  return X_WR;
}

Recording walk(const House& house, const std::vector<Eigen::Vector2d>& waypoints, const WalkConfig& config) {
  const double duration = std::min(config.duration_s, length(waypoints) / config.speed_mps);
  const auto X_WR_at = [&](double t) { return walk_pose(waypoints, config, t); };
  Recording recording;
  recording.calibration = calibration();
  for (std::int64_t message = 0; seconds((message + 1) * columns * firing_period) <= duration; ++message) {
    recording.scans.push_back(scan_message(house, X_WR_at, config, message));
    const Nanoseconds stamp = recording.scans.back().stamp;
    recording.truth.push_back({stamp, X_WR_at(seconds(stamp))});
  }
  recording.odometry = reckon(waypoints, config, recording.scans.empty() ? 0 : recording.scans.back().stamp);
  return recording;
}

Scan standing_scan(const House& house, const Pose& X_WR, const WalkConfig& config) {
  return scan_message(
      house, [&](double) { return X_WR; }, config, 0);
}

Scan without_rings(const Scan& scan) {
  Scan out = scan;
  out.rings = 1;
  out.columns = scan.rings * scan.columns;
  std::size_t to = 0;
  for (int ring = scan.rings - 1; ring >= 0; --ring)
    for (int column = 0; column < scan.columns; ++column, ++to) {
      const auto from = static_cast<std::size_t>(column * scan.rings + ring);
      out.range_m[to] = scan.range_m[from];
      out.point_L[to] = scan.point_L[from];
      if (!scan.reflectivity.empty()) out.reflectivity[to] = scan.reflectivity[from];
      if (!scan.offset_ns.empty()) out.offset_ns[to] = scan.offset_ns[from];
    }
  return out;
}

}  // namespace plumbline::slam::synthetic
