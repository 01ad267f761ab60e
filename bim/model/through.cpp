// SPDX-License-Identifier: Apache-2.0
#include "bim/model/through.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "bim/geometry/interval.h"
#include "bim/model/wall_frame.h"

namespace plumbline::bim {

namespace {

struct Crossing {
  double at = 0.0;  ///< distance along the line
  int outward = 0;  ///< 1: the line leaves the solid here, -1: it enters

  [[nodiscard]] friend bool operator<(const Crossing& a, const Crossing& b) { return a.at < b.at; }
};

/// Where the line from p along d crosses the surface, ascending.
std::vector<Crossing> crossings_of(const Solid& solid, const Eigen::Vector3d& p, const Eigen::Vector3d& d) {
  std::vector<Crossing> found;
  for (const Eigen::Vector3i& t : solid.triangles) {
    const auto corner = [&](int k) { return solid.vertices[static_cast<std::size_t>(t[k])]; };
    const Eigen::Vector3d u = corner(1) - corner(0), v = corner(2) - corner(0), q = d.cross(v);
    const double det = u.dot(q);
    if (std::abs(det) < 1e-12) continue;
    const Eigen::Vector3d w = p - corner(0), r = w.cross(u);
    const double a = w.dot(q) / det, b = d.dot(r) / det;
    if (a >= 0.0 && b >= 0.0 && a + b <= 1.0) found.push_back({v.dot(r) / det, det < 0.0 ? 1 : -1});
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<double> crossings(const Solid& solid, const Eigen::Vector3d& p, const Eigen::Vector3d& d) {
  std::vector<double> at;
  for (const Crossing& crossing : crossings_of(solid, p, d)) at.push_back(crossing.at);
  return at;
}

Interval across_of(const Wall& wall, const WallFrame& frame) {
  return wall.body ? extent_across(frame, {*wall.body}) : Interval{wall.offset_m, wall.offset_m + wall.thickness_m};
}

bool inside(const Solid& solid, const Eigen::Vector3d& p) {
  // Askew, so that it meets no edge between two triangles of a box.
  const Eigen::Vector3d d = Eigen::Vector3d(0.1234, 0.2345, 0.9642).normalized();
  int all = 0, beyond = 0;
  std::size_t count = 0;
  for (const Crossing& crossing : crossings_of(solid, p, d)) {
    all += crossing.outward;
    if (crossing.at <= 0.0) continue;
    beyond += crossing.outward;
    ++count;
  }
  // Parts may overlap, or one be given twice; where faces are turned over their number alone tells.
  return all == 0 ? beyond != 0 : count % 2 == 1;
}

/// From a point in the opening there is a straight level way that leaves the opening outside the wall at both ends, and
/// not just into a cavity of it.
bool free_at(const std::vector<Solid>& hole, const Solid& body, const Eigen::Vector3d& p, const Wall& wall,
             const ThroughConfig& config) {
  constexpr int steps = 5;
  const double normal = std::atan2(wall.left().y(), wall.left().x());
  for (int i = -steps; i <= steps; ++i) {
    const double yaw = normal + config.widest_deg * std::numbers::pi / 180.0 * i / steps;
    const Eigen::Vector3d d(std::cos(yaw), std::sin(yaw), 0.0);
    const bool open = [&] {
      for (const double sign : {-1.0, 1.0}) {
        double end = 0.0;  // of what the parts of the hole leave free on this side
        for (bool grown = true; std::exchange(grown, false);)
          for (const Solid& part : hole)
            for (const double s : crossings(part, p, sign * d))
              if (s > end && inside(part, p + sign * (0.5 * (end + s)) * d)) end = s, grown = true;
        if (inside(body, p + sign * (end + config.depth_m) * d)) return false;
        const double behind = end + config.behind_m / std::cos(yaw - normal);
        const std::vector<double> at = crossings(body, p, sign * d);
        if (std::any_of(at.begin(), at.end(), [&](double s) { return s > end + config.depth_m && s < behind; }))
          return false;
      }
      return true;
    }();
    if (open) return true;
  }
  return false;
}

/// The wall stands left of, right of or above the opening, at its depth: its body has been cut out there already.
/// Beside an opening that misses the wall there is nothing.
bool wall_stands_beside(const Opening& opening, const Interval& depth, const Wall& wall, const WallFrame& frame) {
  constexpr double beside_m = 0.05;
  const double half = 0.5 * opening.width_m + beside_m, middle = 0.5 * (opening.z0_m + opening.z1_m);
  const Eigen::Vector3d d(wall.left().x(), wall.left().y(), 0.0);
  for (const Eigen::Vector2d& p :
       {Eigen::Vector2d(opening.s_m - half, middle), Eigen::Vector2d(opening.s_m + half, middle),
        Eigen::Vector2d(opening.s_m, opening.z1_m + beside_m)}) {
    const std::vector<double> at = crossings(*wall.body, frame.to_world({p.x(), depth.low, p.y()}), d);
    for (std::size_t i = 0; i + 1 < at.size(); i += 2)
      if (gap({at[i], at[i + 1]}, {0.0, depth.length()}) < 0.0) return true;
  }
  return false;
}

}  // namespace

bool goes_through(const Opening& opening, const Wall& wall, const ThroughConfig& config) {
  const std::vector<Solid> hole = solids_of(opening);
  if (hole.empty()) return true;
  const WallFrame frame(wall);
  const Interval depth = extent_across(frame, hole);
  const Interval y = across_of(wall, frame);
  if (depth.low <= y.low + config.depth_m && depth.high >= y.high - config.depth_m) return true;
  if (!wall.body) return false;
  // The wall may be curved or clipped: what counts is what is left of it around the opening.
  int free = 0, places = 0;
  const double middle = 0.5 * (depth.low + depth.high);
  for (const double along : {-0.27, 0.01, 0.26})
    for (const double up : {0.24, 0.51, 0.77}) {
      const double s = opening.s_m + along * opening.width_m;
      const double z = opening.z0_m + up * (opening.z1_m - opening.z0_m);
      const Eigen::Vector3d foot = frame.to_world({s, middle, z});
      const Eigen::Vector3d d(wall.left().x(), wall.left().y(), 0.0);
      for (const Solid& part : hole) {
        const std::vector<double> at = crossings(part, foot, d);
        if (at.size() < 2) continue;
        // Of the part's stretch, what lies in the wall.
        std::vector<double> cuts = crossings(*wall.body, foot, d);
        cuts.push_back(at.front());
        cuts.push_back(at.back());
        std::sort(cuts.begin(), cuts.end());
        for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
          const Eigen::Vector3d p = foot + 0.5 * (cuts[i] + cuts[i + 1]) * d;
          if (cuts[i + 1] - cuts[i] < 1e-4 || !inside(part, p) || !inside(*wall.body, p)) continue;
          ++places;
          if (free_at(hole, *wall.body, p, wall, config)) ++free;
        }
      }
    }
  return places > 0 ? 2 * free >= places : wall_stands_beside(opening, depth, wall, frame);
}

bool opens_on(const Opening& opening, const Wall& wall, int side, const ThroughConfig& config) {
  if (goes_through(opening, wall, config)) return true;
  const WallFrame frame(wall);
  const Interval depth = extent_across(frame, solids_of(opening)), y = across_of(wall, frame);
  return side == 0 ? depth.high >= y.high - config.depth_m : depth.low <= y.low + config.depth_m;
}

double extend_through(Opening& opening, const Wall& wall, const ThroughConfig& config) {
  std::vector<Solid> hole = solids_of(opening);
  if (hole.empty() || !wall.body || goes_through(opening, wall, config)) return 0.0;
  const WallFrame frame(wall);
  const Interval depth = extent_across(frame, hole), y = extent_across(frame, {*wall.body});
  const double low = std::max(0.0, depth.low - y.low), high = std::max(0.0, y.high - depth.high);
  if (std::max(low, high) <= config.depth_m || low + high > config.short_m || low + high > 0.5 * y.length()) return 0.0;
  const auto extend = [&](Solid& solid) {
    for (Eigen::Vector3d& p_W : solid.vertices) {
      Eigen::Vector3d p = frame.to_wall(p_W);
      if (p.y() < depth.low + config.depth_m) p.y() -= low;
      if (p.y() > depth.high - config.depth_m) p.y() += high;
      p_W = frame.to_world(p);
    }
  };
  if (opening.solid) extend(*opening.solid);
  for (Solid& part : opening.parts) extend(part);
  return low + high;
}

}  // namespace plumbline::bim
