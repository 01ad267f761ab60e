// SPDX-License-Identifier: Apache-2.0
#include "slam/planes/mount_height.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "bim/median.h"
#include "slam/planes/level.h"
#include "slam/planes/observe.h"

namespace plumbline::slam {

namespace {

/// Of a road, which is no plane: the median of the lowest returns of squares of a metre round the LiDAR, where most lie
/// about as deep. A tilt of the LiDAR cancels, all around.
std::optional<double> height_by_lowest(const DeskewedScan& scan) {
  // Assumed; looked at on two recordings of streets, where 1.79 m came out for a LiDAR at 1.73 m.
  constexpr double nearest_m = 1.5, farthest_m = 8.0, most_apart_m = 0.2;
  constexpr std::size_t least = 24;
  std::map<std::pair<int, int>, double> lowest;
  for (std::size_t i = 0; i < scan.range_m.size(); ++i) {
    const Eigen::Vector3d p_L = scan.point_R[i] - scan.X_RL.t;
    const double range = p_L.head<2>().norm();
    if (scan.range_m[i] <= 0.0 || range < nearest_m || range > farthest_m || p_L.z() > 0.0) continue;
    const std::pair square(static_cast<int>(std::floor(p_L.x())), static_cast<int>(std::floor(p_L.y())));
    const auto place = lowest.try_emplace(square, p_L.z()).first;
    place->second = std::min(place->second, p_L.z());
  }
  if (lowest.size() < least) return std::nullopt;
  std::vector<double> heights;
  for (const auto& [square, z] : lowest) heights.push_back(-z);
  const double middle = upper_median(heights);
  const auto near = std::count_if(heights.begin(), heights.end(),
                                  [&](double height) { return std::abs(height - middle) < most_apart_m; });
  return 2 * static_cast<std::size_t>(near) > heights.size() ? std::optional(middle) : std::nullopt;
}

/// How many returns lie farther below a plane.
double returns_below(const DeskewedScan& scan, const PlaneObservation& plane, double farther_m) {
  double count = 0.0;
  for (std::size_t i = 0; i < scan.range_m.size(); ++i)
    if (scan.range_m[i] > 0.0 && plane.plane_R.distance(scan.point_R[i]) < -farther_m) ++count;
  return count;
}

/// Height above a floor, and the share of the directions with returns in which that floor is seen.
struct SeenHeight {
  double height_m = 0.0;
  double share = 0.0;
};

std::optional<SeenHeight> height_in(const Scan& scan, const Calibration& calibration, std::uint64_t seed) {
  const DeskewedScan raw = as_deskewed(scan, calibration);
  const std::vector<PlaneObservation> seen = observe_planes(raw, {}, RinglessRansacConfig(), seed);
  const std::optional<Eigen::Vector3d> up_R = up_by_planes(seen);
  constexpr double most_tilt = 0.1;      // LocalizationScanConfig::floor_max_tilt_rad
  constexpr double least_reach_m = 2.0;  // nearer lies the robot itself
  // Assumed; looked at where a desk of 0.75 m stood beside a LiDAR at 1 m.
  constexpr double step_m = 0.2, least_share = 0.1, most_below = 0.25;
  const PlaneObservation* floor = nullptr;
  const auto depth = [&](const PlaneObservation& plane) { return plane.plane_R.distance(calibration.X_RL.t); };
  const auto may_be_floor = [&](const PlaneObservation& plane) {
    const Eigen::Vector3d& from_R = calibration.X_RL.t;
    const bool is_around = std::max((plane.p0_R - from_R).norm(), (plane.p1_R - from_R).norm()) > least_reach_m;
    return is_floor(plane) && is_around && depth(plane) > 0.0 && up_R &&
           plane.plane_R.n.dot(*up_R) > std::cos(most_tilt);
  };
  for (const PlaneObservation& plane : seen)
    if (may_be_floor(plane) && (floor == nullptr || plane.points > floor->points)) floor = &plane;
  const auto by_plane = [&](const PlaneObservation& plane) {
    return SeenHeight{depth(plane), share_of_directions(raw, plane.plane_R)};
  };
  const auto by_lowest = [&]() -> std::optional<SeenHeight> {
    const std::optional<double> height = height_by_lowest(raw);  // all around
    return height ? std::optional(SeenHeight{*height, 1.0}) : std::nullopt;
  };
  if (floor == nullptr) return by_lowest();
  // A desk beside the LiDAR may hold more returns than the floor behind it.
  const PlaneObservation* lowest = floor;
  for (const PlaneObservation& plane : seen)
    if (may_be_floor(plane) && plane.points >= least_share * floor->points && depth(plane) > depth(*lowest) + step_m &&
        stands_on_lower(raw, plane.plane_R, lowest->plane_R))
      lowest = &plane;
  if (lowest != floor) return by_plane(*lowest);
  const double below = most_below * floor->points;
  return returns_below(raw, *floor, step_m) > below ? by_lowest() : by_plane(*floor);
}

/// Median of the scans that see a floor; none where fewer than a third do.
std::optional<SeenHeight> median_height(std::span<const Scan> scans, const Calibration& calibration,
                                        std::uint64_t seed) {
  std::vector<double> heights, shares;
  for (const Scan& scan : scans)
    if (const std::optional<SeenHeight> seen = height_in(scan, calibration, seed)) {
      heights.push_back(seen->height_m);
      shares.push_back(seen->share);
    }
  if (heights.empty() || 3 * heights.size() < scans.size()) return std::nullopt;
  return SeenHeight{upper_median(heights), upper_median(shares)};
}

}  // namespace

std::optional<double> height_over_floor(std::span<const Scan> scans, const Calibration& calibration,
                                        std::uint64_t seed) {
  const std::optional<SeenHeight> seen = median_height(scans, calibration, seed);
  return seen ? std::optional(seen->height_m) : std::nullopt;
}

std::optional<double> height_over_floor(Recording& recording, const Calibration& calibration, std::uint64_t seed) {
  constexpr std::size_t enough = 10, left_out = 20;  // scans in a row
  constexpr double longest_s = 30.0, clear = 0.25;
  std::optional<Nanoseconds> first;
  std::optional<SeenHeight> best;
  std::vector<Scan> scans;
  std::size_t skip = 0;
  const auto judge = [&] {
    const std::optional<SeenHeight> seen = median_height(scans, calibration, seed);
    if (seen && (!best || seen->share > best->share)) best = seen;
    scans.clear();
  };
  for (SensorFrame frame; (!best || best->share < clear) && recording.next(frame);) {
    if (!first) first = frame.scan.stamp;
    if (seconds(frame.scan.stamp - *first) > longest_s) break;
    if (skip > 0) {
      --skip;
      continue;
    }
    scans.push_back(std::move(frame.scan));
    if (scans.size() < enough) continue;
    judge();
    skip = left_out;
  }
  if (!best && !scans.empty()) judge();
  return best ? std::optional(best->height_m) : std::nullopt;
}

}  // namespace plumbline::slam
