// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/exploration_route.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bim/geometry/polygon.h"

namespace plumbline::scenarios {

namespace {

using Path = std::vector<Eigen::Vector2d>;

struct Candidate {
  Eigen::Vector2d p = Eigen::Vector2d::Zero();
  double distance_m = std::numeric_limits<double>::infinity();  ///< distance to the walk so far
};

/// Those of a grid over the box that can be walked to and left again: from most of them the walk goes back.
std::vector<Candidate> places_in_reach(const sim::ClearanceMap& space, const Eigen::AlignedBox2d& bounds,
                                       const Eigen::Vector2d& start, const ExplorationConfig& config) {
  const double step = std::max(config.step_m, std::sqrt(bounds.volume() / config.most_places));
  const Eigen::Vector2d size = bounds.sizes();
  const double turn_m = space.config().turn_m - 0.5 * space.config().cell_m;
  Path grid;
  for (int iy = 0; (iy + 0.5) * step < size.y(); ++iy)
    for (int ix = 0; (ix + 0.5) * step < size.x(); ++ix) {
      const Eigen::Vector2d p = bounds.min() + step * Eigen::Vector2d(ix + 0.5, iy + 0.5);
      if (space.clearance(p) >= turn_m) grid.push_back(p);
    }
  std::vector<Candidate> places;
  for (const Eigen::Vector2d& p : space.reachable(start, grid)) places.push_back({p});
  return places;
}

void update_distances(const Path& path, std::vector<Candidate>& places) {
  for (Candidate& place : places)
    for (std::size_t i = 0; i < path.size(); ++i)
      place.distance_m = std::min(place.distance_m, segment_distance(path[i > 0 ? i - 1 : 0], path[i], place.p));
}

double length(const Path& path) {
  double sum = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) sum += (path[i] - path[i - 1]).norm();
  return sum;
}

}  // namespace

Eigen::AlignedBox2d floor_box(const bim::Building& building, int storey) {
  constexpr double beside_m = 1.0;  // of a wall that stands alone
  Eigen::AlignedBox2d box;
  for (const bim::Slab& slab : building.slabs)
    for (const Eigen::Vector2d& p : slab.polygon.outer)
      if (slab.storey == storey) box.extend(p);
  if (!box.isEmpty()) return box;
  for (const bim::Wall& wall : building.walls)
    if (wall.storey == storey) box.extend(wall.a).extend(wall.b);
  if (box.isEmpty() || box.sizes().minCoeff() >= beside_m) return box;
  return {Eigen::Vector2d(box.min().array() - beside_m), Eigen::Vector2d(box.max().array() + beside_m)};
}

std::vector<Eigen::Vector2d> exploration_route(const sim::ClearanceMap& space, const Eigen::AlignedBox2d& bounds,
                                               const Eigen::Vector2d& start, const ExplorationConfig& config) {
  std::vector<Candidate> places = places_in_reach(space, bounds, start, config);
  Path walk = {start};
  update_distances(walk, places);
  for (int goals = 0; goals < config.goals && length(walk) < config.longest_m; ++goals) {
    const auto goal = std::max_element(places.begin(), places.end(), [](const Candidate& a, const Candidate& b) {
      return a.distance_m < b.distance_m;
    });
    if (goal == places.end() || goal->distance_m < config.nearest_m) break;
    const Path leg = space.path(walk.back(), goal->p);
    walk.insert(walk.end(), leg.begin() + 1, leg.end());
    update_distances(leg, places);
  }
  const Path home = space.path(walk.back(), start);
  if (walk.size() > 1 && home.size() > 1) walk.insert(walk.end(), home.begin() + 1, home.end());
  return walk;
}

}  // namespace plumbline::scenarios
