// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bim/model/building.h"
#include "sim/route/narrow.h"
#include "sim/route/route.h"
#include "sim/route/stair_way.h"
#include "sim/route/waypoint.h"

namespace plumbline::sim {

/// A point on the floor of a storey.
struct FloorPoint {
  int storey = -1;
  Eigen::Vector2d p_W = Eigen::Vector2d::Zero();
};

struct MultiStoreyPlannerConfig {
  RouteConfig route;
  StairWayConfig stair;
  NarrowConfig narrow;
  double approach_m = 0.7;      ///< preferred between a stair and where the robot lines up with it,
  double approach_min_m = 0.4;  ///< and the least
  double approach_step_m = 0.05;
  double stairs_cost = 2.0;  ///< a metre of stair counts as so many of floor
};

/// Where a robot can walk in a building: the free space of every storey, joined by the stairs it can climb. Computed on
/// demand; not for several threads at once.
class MultiStoreyPlanner {
 public:
  /// The building must outlive it.
  explicit MultiStoreyPlanner(const bim::Building& as_built, const MultiStoreyPlannerConfig& config = {});

  [[nodiscard]] const bim::Building& building() const { return building_; }
  /// Free space of one storey. Throws InputError when the storey is too large.
  [[nodiscard]] const ClearanceMap& storey(int index) const;
  /// Waypoints from a to b, both included; empty when b cannot be reached. Where b is on a's storey and can be reached
  /// on it, no stair is taken; else the shortest path over stairs (ties: the stairs listed first).
  [[nodiscard]] std::vector<Waypoint> path(const FloorPoint& a, const FloorPoint& b) const;
  /// Storeys that can be reached from a point over stairs, the point's own included, ascending.
  [[nodiscard]] std::vector<int> reachable_storeys(const FloorPoint& a) const;
  /// Every stair, with what is wrong with it and with the room before and beyond it.
  [[nodiscard]] const std::vector<StairWay>& stairs() const;

 private:
  struct Search;
  using Path = std::vector<Waypoint>;
  [[nodiscard]] Path on_storey(const FloorPoint& a, const FloorPoint& b) const;
  [[nodiscard]] Path over_stair(const StairWay& way, bool up) const;
  void add_approaches(StairWay& way) const;
  [[nodiscard]] bool add_approach(int storey, const Eigen::Vector3d& edge, const Eigen::Vector2d& away,
                                  Eigen::Vector3d& point) const;
  [[nodiscard]] std::vector<FloorPoint> portals() const;
  [[nodiscard]] Search search(const FloorPoint& a, const FloorPoint* goal) const;

  const bim::Building& building_;
  MultiStoreyPlannerConfig config_;
  mutable std::map<int, std::unique_ptr<ClearanceMap>> storeys_;
  mutable std::unique_ptr<std::vector<StairWay>> stairs_;
  mutable std::map<std::pair<std::size_t, std::size_t>, Path> between_portals_;
};

}  // namespace plumbline::sim
