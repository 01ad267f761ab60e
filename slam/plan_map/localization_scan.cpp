// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_map/localization_scan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "bim/geometry/polygon.h"
#include "slam/planes/level.h"

namespace plumbline::slam {

namespace {

/// Height of R above the floor: by the lowest of the level planes below that hold a tenth of the returns of the
/// largest, where it is no farther from the calibrated one than given. A table may hold more returns than the floor
/// beside it, or hide it; the ground outdoors lies lower.
std::optional<double> height_over_floor(const DeskewedScan& raw, const std::vector<PlaneObservation>& planes,
                                        const LocalizationScan& scan, double tilt, double calibrated_R,
                                        double tolerance_m) {
  // No gait, crouch or hand lowers a LiDAR as far; seats are 0.4 m high, tables more.
  constexpr double nearest_m = 0.3;
  constexpr double least_share = 0.1;  // assumed
  std::vector<const PlaneObservation*> level;
  const PlaneObservation* largest = nullptr;
  for (const PlaneObservation& plane : planes) {
    const double lower = plane.plane_R.d - calibrated_R;
    if ((scan.q_HR * plane.plane_R.n).z() < std::cos(tilt) || !scan.is_below(plane.plane_R) || lower > tolerance_m ||
        lower < -std::min(tolerance_m, nearest_m))
      continue;
    // Assumed: a floor, also that below a landing, is seen in more directions than the ground through windows.
    constexpr double ground_m = 0.6;  // below the floor of a building at most, where it is not farther than a landing
    constexpr double few = 0.25;
    if (lower > nearest_m / 2.0 && lower < ground_m && share_of_directions(raw, plane.plane_R) < few) continue;
    level.push_back(&plane);
    if (largest == nullptr || plane.points > largest->points) largest = &plane;
  }
  const PlaneObservation* floor = largest;
  for (const PlaneObservation* plane : level)
    if (plane->points >= least_share * largest->points && plane->plane_R.d > floor->plane_R.d &&
        stands_on_lower(raw, plane->plane_R, floor->plane_R))
      floor = plane;
  return floor == nullptr ? std::nullopt : std::optional(floor->plane_R.d);
}

std::optional<Beam> beam_to(const Eigen::Vector3d& p_R, const LocalizationScan& out, const Eigen::Vector3d& sensor_R,
                            const LocalizationScanConfig& config) {
  const Eigen::Vector3d ray_H = out.q_HR * (p_R - sensor_R);
  const double range = ray_H.head<2>().norm();
  const double height = out.sensor_height + ray_H.z();
  if (range < config.min_range_m || range > config.max_range_m) return std::nullopt;
  if (height < config.min_height_m || height > config.max_height_m) return std::nullopt;
  return Beam{ray_H.head<2>() / range, range, ray_H.z() / range};
}

/// Slots as columns of several rings. Those of a scan without rings are dealt out in their order.
struct SlotLayout {
  int columns, rings;
};

SlotLayout layout_of(const DeskewedScan& scan) {
  constexpr int least = 4, dealt = 16;
  if (scan.rings >= least || scan.columns * scan.rings < dealt) return {scan.columns, scan.rings};
  return {scan.columns * scan.rings / dealt, dealt};
}

/// Elevation of each ring, rad: the mean over some of the columns; none for a ring without returns there.
std::vector<std::optional<double>> elevations_of(const DeskewedScan& scan) {
  constexpr int most_columns = 32;
  std::vector<std::optional<double>> all(static_cast<std::size_t>(scan.rings));
  const Pose X_LR = scan.X_RL.inverse();
  const int step = std::max(1, scan.columns / most_columns);
  for (int ring = 0; ring < scan.rings; ++ring) {
    double sum = 0.0;
    int count = 0;
    for (int column = 0; column < scan.columns; column += step) {
      const auto i = static_cast<std::size_t>(column * scan.rings + ring);
      if (scan.range_m[i] <= 0.0) continue;
      const Eigen::Vector3d p_L = X_LR * scan.point_R[i];
      sum += std::atan2(p_L.z(), p_L.head<2>().norm());
      ++count;
    }
    if (count > 0) all[static_cast<std::size_t>(ring)] = sum / count;
  }
  return all;
}

/// The rings of which beams are taken in turn: those of a VLP-16 at -1, 3, 7 and 11 degrees, and whose elevations are
/// nearest of other LiDARs.
std::array<int, 4> beam_rings(const DeskewedScan& scan, const SlotLayout& layout) {
  constexpr int vlp16_rings = 16;
  std::array<int, 4> rings{};
  for (int k = 0; k < 4; ++k) rings[static_cast<std::size_t>(k)] = layout.rings / 2 - 1 + 2 * k;
  if (layout.rings == vlp16_rings) return rings;
  const std::vector<std::optional<double>> known = elevations_of(scan);
  for (int k = 0; k < 4; ++k) {
    const double wanted = (4.0 * k - 1.0) * std::numbers::pi / 180.0;
    double nearest = std::numeric_limits<double>::infinity();
    for (int ring = 0; ring < scan.rings; ++ring) {
      const std::optional<double>& elevation = known[static_cast<std::size_t>(ring)];
      if (!elevation || std::abs(*elevation - wanted) >= nearest) continue;
      nearest = std::abs(*elevation - wanted);
      rings[static_cast<std::size_t>(k)] = ring;
    }
  }
  return rings;
}

/// One beam per step of the turn; the ring changes from step to step so that sills, heads of doors and low furniture
/// are all hit. The nearest ring with a usable return is taken.
std::vector<Beam> pick_beams(const DeskewedScan& scan, const LocalizationScan& out,
                             const LocalizationScanConfig& config) {
  std::vector<Beam> beams;
  const SlotLayout layout = layout_of(scan);
  const auto [columns, rings] = layout;
  if (columns == 0) return beams;
  const std::array<int, 4> in_turn = beam_rings(scan, layout);
  for (int k = 0; k < config.beams; ++k) {
    const int column = static_cast<int>(static_cast<long>(k) * columns / config.beams);
    const int wanted = in_turn[static_cast<std::size_t>(k % 4)];
    for (int step = 0; step < rings; ++step) {
      const int ring = wanted + (step % 2 == 0 ? step / 2 : -(step + 1) / 2);
      if (ring < 0 || ring >= rings) continue;
      const auto i = static_cast<std::size_t>(column * rings + ring);
      if (scan.range_m[i] <= 0.0) continue;
      const std::optional<Beam> beam = beam_to(scan.point_R[i], out, scan.X_RL.t, config);
      if (!beam) continue;
      beams.push_back(*beam);
      break;
    }
  }
  return beams;
}

/// Mean velocity of the sensor in R during the scan, by how much the ranges to the sensor at the stamp differ from
/// those measured, m/s; zero where returns have no times.
Eigen::Vector3d velocity_during(const DeskewedScan& scan) {
  Eigen::Matrix3d H = 1e-9 * Eigen::Matrix3d::Identity();
  Eigen::Vector3d g = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < scan.time_s.size(); ++i) {
    if (scan.range_m[i] <= 0.0) continue;
    const Eigen::Vector3d ray_R = scan.point_R[i] - scan.X_RL.t;
    const double range = ray_R.norm();
    if (range <= 0.0) continue;
    const Eigen::Vector3d J = static_cast<double>(scan.time_s[i]) / range * ray_R;
    H += J * J.transpose();
    g += J * (range - scan.range_m[i]);
  }
  const Eigen::Vector3d v = H.ldlt().solve(g);
  return v.allFinite() ? v : Eigen::Vector3d::Zero();
}

BeamGrid make_beam_grid(const DeskewedScan& scan, const LocalizationScan& out, const LocalizationScanConfig& config) {
  constexpr int wide = 4;
  const Eigen::Vector2d v_H = (out.q_HR * velocity_during(scan)).head<2>();
  const SlotLayout layout = layout_of(scan);
  BeamGrid grid{std::min(config.grid_columns, layout.columns), {}};
  const int rings = std::min(config.grid_rings, layout.rings);
  for (int first = 0; first < rings; first += wide)
    for (int c = 0; c < grid.columns; ++c) {
      const int column = static_cast<int>(static_cast<long>(c) * layout.columns / grid.columns);
      BeamGridBlock& block = grid.blocks.emplace_back();
      for (int r = first; r < std::min(first + wide, rings); ++r) {
        const auto i = static_cast<std::size_t>(column * layout.rings + r * layout.rings / rings);
        if (scan.range_m[i] <= 0.0) continue;
        const std::optional<Beam> beam = beam_to(scan.point_R[i], out, scan.X_RL.t, config);
        if (!beam) continue;
        const auto k = static_cast<std::size_t>(r - first);
        block.x[k] = static_cast<float>(beam->direction_H.x());
        block.y[k] = static_cast<float>(beam->direction_H.y());
        block.range[k] = static_cast<float>(beam->range);
        block.slope[k] = static_cast<float>(beam->slope);
        if (scan.time_s.empty()) continue;
        const Eigen::Vector2d& d = beam->direction_H;
        block.aside[k] = static_cast<float>(std::abs((d.x() * v_H.y() - d.y() * v_H.x()) * scan.time_s[i]));
      }
    }
  return grid;
}

std::optional<WallObservation> wall_observation(const PlaneObservation& plane, const LocalizationScan& out,
                                                const Eigen::Vector3d& sensor_R, const LocalizationScanConfig& config) {
  if (!plane.vertical) return std::nullopt;
  const Eigen::Vector3d n_H = out.q_HR * plane.plane_R.n;
  const double level = n_H.head<2>().norm();
  const Eigen::Vector2d along(n_H.y() / level, -n_H.x() / level);
  const auto coordinate = [&](const Eigen::Vector3d& p_R) {
    return along.dot((out.q_HR * (p_R - sensor_R)).head<2>());
  };
  const double top = out.sensor_height + plane.z1 - sensor_R.z();
  const double a = coordinate(plane.p0_R), b = coordinate(plane.p1_R);
  if (std::abs(a - b) < config.min_wall_length_m || top < config.min_wall_top_m) return std::nullopt;
  WallObservation wall;
  wall.azimuth = std::atan2(n_H.y(), n_H.x());
  wall.distance = plane.plane_R.distance(sensor_R) / level;
  wall.s0 = std::min(a, b);
  wall.s1 = std::max(a, b);
  wall.sigma_azimuth = std::sqrt(plane.covariance(0, 0));
  wall.sigma_distance = std::sqrt(plane.covariance(2, 2));
  return wall;
}

}  // namespace

double wall_height(const bim::Plan& plan, const LocalizationScanConfig& config) {
  // A ceiling is hit at a glance: a degree of tilt moves a hit by metres, so it is no wall. Below it lie coverings.
  constexpr double below_m = 0.08, share = 0.1, person_m = 1.8;  // in lower ones, as ducts, no robot walks upright
  std::vector<std::pair<double, double>> heights;                // of rooms, with their areas
  double total = 0.0;
  for (const bim::PlanRoom& room : plan.rooms) {
    if (room.z1 - room.z0 < person_m) continue;
    heights.emplace_back(room.z1 - room.z0, std::abs(signed_area(room.polygon)));
    total += heights.back().second;
  }
  std::sort(heights.begin(), heights.end());
  double area = 0.0;
  for (const auto& [height, own] : heights) {
    area += own;
    if (area >= share * total) return std::min(config.max_height_m, height - below_m);
  }
  return config.max_height_m;
}

LocalizationScan make_localization_scan(const DeskewedScan& scan, const std::vector<PlaneObservation>& planes,
                                        const Pose& X_OR, const Calibration& calibration,
                                        const LocalizationScanConfig& config, double height_tolerance_m) {
  LocalizationScan out;
  out.stamp = scan.stamp;
  out.X_OR = X_OR;
  out.q_HR = exp_so3({0.0, 0.0, -X_OR.yaw()}) * X_OR.q;
  const Eigen::Vector3d sensor_H = out.q_HR * scan.X_RL.t;
  out.sensor_H = sensor_H.head<2>();
  out.sensor_R = scan.X_RL.t;
  const double calibrated_R = calibration.sensor_height_m - sensor_H.z();
  out.sensor_height =
      sensor_H.z() + height_over_floor(scan, planes, out, config.floor_max_tilt_rad, calibrated_R, height_tolerance_m)
                         .value_or(calibrated_R);
  out.beams = pick_beams(scan, out, config);
  out.beam_grid = make_beam_grid(scan, out, config);
  for (std::size_t i = 0; i < planes.size() && out.walls.size() < max_walls; ++i) {
    std::optional<WallObservation> wall = wall_observation(planes[i], out, scan.X_RL.t, config);
    if (!wall) continue;
    wall->observation = static_cast<int>(i);
    out.walls.push_back(*wall);
  }
  return out;
}

}  // namespace plumbline::slam
