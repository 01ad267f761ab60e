// SPDX-License-Identifier: Apache-2.0
#include "sim/route/multi_storey_planner.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "bim/config/tree.h"
#include "bim/model/stair_flight.h"
#include "sim/robot/ground.h"
#include "sim/robot/types/dimensions.h"

namespace plumbline::sim {

namespace {

constexpr double same_place_m = 1e-9;

void append(const std::vector<Waypoint>& segment, std::vector<Waypoint>& path) {
  const bool joined = !path.empty() && !segment.empty();
  path.insert(path.end(), segment.begin() + (joined ? 1 : 0), segment.end());
}

/// Longest stretch from `from` to `to`, at one height, without floor under a foot, m.
double gap_between(const Ground& ground, const Eigen::Vector3d& from, const Eigen::Vector2d& to, double lowest_m) {
  constexpr double sample_m = 0.01;
  const Eigen::Vector2d way = to - from.head<2>(), left = Eigen::Vector2d(-way.y(), way.x()).normalized();
  const double foot = robot_dimensions.hip_y + robot_dimensions.abduction;
  const int count = static_cast<int>(std::ceil(way.norm() / sample_m));
  double most = 0.0;
  for (const double side : {-foot, 0.0, foot}) {
    double gap = 0.0;
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector2d p = from.head<2>() + ((i + 0.5) / count) * way + side * left;
      const bool carries = ground.height(p.x(), p.y(), from.z() + lowest_m) >= from.z() - lowest_m;
      gap = carries ? 0.0 : gap + way.norm() / count;
      most = std::max(most, gap);
    }
  }
  return most;
}

std::string gap_fault(double gap_m, const std::string& where) {
  constexpr double most_m = 0.12;  // 0.1 m, tried, and what the edges of wells are found to
  const auto metres = [](double x) { return format_number(std::round(x * 1e2) / 1e2) + " m"; };
  if (gap_m <= most_m) return "";
  return "has a gap of " + metres(gap_m) + " in the floor " + where + "; the robot steps over " + metres(most_m);
}

/// The floor map closes gaps under walls; a foot beyond the last step finds what is there.
void find_gaps(const bim::Building& building, const StairWayConfig& config, std::vector<StairWay>& ways) {
  std::vector<int> storeys;
  for (const StairWay& way : ways)
    if (way.fault.empty()) storeys.insert(storeys.end(), {way.from, way.to});
  if (storeys.empty()) return;
  std::sort(storeys.begin(), storeys.end());
  storeys.erase(std::unique(storeys.begin(), storeys.end()), storeys.end());
  const Ground ground = building_ground(building, storeys);
  const double lowest_m = 2.0 * config.rise_max_m;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    StairWay& way = ways[i];
    if (!way.fault.empty()) continue;
    const bim::Stair& stair = building.stairs[i];
    const Eigen::Vector2d foot = stair.flights.front().start, head = bim::head_of(stair.flights.back(), 0.0);
    const Eigen::Vector3d &first = way.points.front(), &last = way.points.back();
    way.fault = gap_fault(gap_between(ground, {foot.x(), foot.y(), first.z()}, first.head<2>(), lowest_m),
                          "before its first step");
    if (way.fault.empty())
      way.fault = gap_fault(gap_between(ground, {head.x(), head.y(), last.z()}, last.head<2>(), lowest_m),
                            "beyond its last step");
  }
}

}  // namespace

/// Shortest paths from one point to all portals (two a stair: foot, head) and to the goal, which is the last node.
struct MultiStoreyPlanner::Search {
  std::vector<double> cost;
  std::vector<std::size_t> before;  ///< node, itself at the start
  std::vector<Path> segment;        ///< from `before`

  [[nodiscard]] Path path_to(std::size_t node) const {
    std::vector<std::size_t> nodes = {node};
    while (before[nodes.back()] != nodes.back()) nodes.push_back(before[nodes.back()]);
    Path path;
    for (auto it = nodes.rbegin() + 1; it != nodes.rend(); ++it) append(segment[*it], path);
    return path;
  }
};

MultiStoreyPlanner::MultiStoreyPlanner(const bim::Building& as_built, const MultiStoreyPlannerConfig& config)
    : building_(as_built), config_(config) {}

const ClearanceMap& MultiStoreyPlanner::storey(int index) const {
  std::unique_ptr<ClearanceMap>& space = storeys_[index];
  if (!space) space = std::make_unique<ClearanceMap>(building_, index, config_.route);
  return *space;
}

bool MultiStoreyPlanner::add_approach(int storey_index, const Eigen::Vector3d& edge, const Eigen::Vector2d& away,
                                      Eigen::Vector3d& point) const {
  const ClearanceMap& space = storey(storey_index);
  const int steps = static_cast<int>((config_.approach_m - config_.approach_min_m) / config_.approach_step_m + 0.5);
  for (int i = 0; i <= steps; ++i) {
    const Eigen::Vector2d p = edge.head<2>() + (config_.approach_m - i * config_.approach_step_m) * away;
    if (!space.free(p)) continue;
    point = {p.x(), p.y(), edge.z()};
    return true;
  }
  return false;
}

void MultiStoreyPlanner::add_approaches(StairWay& way) const {
  Eigen::Vector3d first, last;
  if (!add_approach(way.from, way.points.front(), -way.into, first))
    way.fault = "has no room before its first step";
  else if (!add_approach(way.to, way.points.back(), way.out_of, last))
    way.fault = "has no room beyond its last step";
  else {
    way.points.front() = first;
    way.points.back() = last;
  }
}

const std::vector<StairWay>& MultiStoreyPlanner::stairs() const {
  if (stairs_) return *stairs_;
  auto ways = std::make_unique<std::vector<StairWay>>(stair_ways(building_, config_.route, config_.stair));
  for (StairWay& way : *ways)
    if (way.fault.empty()) add_approaches(way);
  find_gaps(building_, config_.stair, *ways);
  stairs_ = std::move(ways);
  return *stairs_;
}

MultiStoreyPlanner::Path MultiStoreyPlanner::on_storey(const FloorPoint& a, const FloorPoint& b) const {
  const ClearanceMap& space = storey(a.storey);
  const double z = space.ground_W();
  if ((b.p_W - a.p_W).norm() < same_place_m) return {{{a.p_W.x(), a.p_W.y(), z + space.height(a.p_W)}, false}};
  Path path;
  for (const PathPart& part : space.parts(a.p_W, b.p_W)) {
    if (!part.step) {
      std::vector<Waypoint> way = with_clearance(space, part.points, z + part.height_m, config_.narrow);
      for (Waypoint& at : way)
        if (const double height = space.height(at.p_W.head<2>());
            std::abs(height - part.height_m) > config_.route.flat_m)
          at.p_W.z() = z + height;
      append(way, path);
      continue;
    }
    const Eigen::Vector2d &foot = part.points.front(), &head = part.points.back();
    append({{{foot.x(), foot.y(), z + space.height(foot)}}, {{head.x(), head.y(), z + part.height_m}, true}}, path);
  }
  return path;
}

MultiStoreyPlanner::Path MultiStoreyPlanner::over_stair(const StairWay& way, bool up) const {
  Path path;
  for (const Eigen::Vector3d& p : way.points) path.push_back({p, true});
  if (!up) std::reverse(path.begin(), path.end());
  path.front().stairs = false;
  return path;
}

std::vector<FloorPoint> MultiStoreyPlanner::portals() const {
  std::vector<FloorPoint> places;
  for (const StairWay& way : stairs()) {
    const bool usable = way.fault.empty();
    places.push_back(usable ? FloorPoint{way.from, way.points.front().head<2>()} : FloorPoint{});
    places.push_back(usable ? FloorPoint{way.to, way.points.back().head<2>()} : FloorPoint{});
  }
  return places;
}

/// Dijkstra over the portals; of equal costs the node with the lower index goes first.
MultiStoreyPlanner::Search MultiStoreyPlanner::search(const FloorPoint& a, const FloorPoint* goal) const {
  std::vector<FloorPoint> nodes = portals();
  const std::size_t portal_count = nodes.size(), start = nodes.size();
  nodes.push_back(a);
  if (goal != nullptr) nodes.push_back(*goal);
  constexpr double unknown = std::numeric_limits<double>::infinity();
  Search search{std::vector<double>(nodes.size(), unknown), std::vector<std::size_t>(nodes.size(), start),
                std::vector<Path>(nodes.size())};
  std::vector<char> done(nodes.size(), 0);
  search.cost[start] = 0.0;
  const auto offer = [&](std::size_t from, std::size_t to, const Path& segment, double weight) {
    const double cost = search.cost[from] + weight * length(segment);
    if (segment.empty() || done[to] != 0 || cost >= search.cost[to]) return;
    search.cost[to] = cost;
    search.before[to] = from;
    search.segment[to] = segment;
  };
  const auto walk = [&](std::size_t from, std::size_t to) -> Path {
    if (from >= portal_count || to >= portal_count) return on_storey(nodes[from], nodes[to]);
    const auto [cached, is_new] = between_portals_.try_emplace({from, to});
    if (is_new) cached->second = on_storey(nodes[from], nodes[to]);
    return cached->second;
  };
  while (true) {
    std::size_t node = nodes.size();
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (done[i] == 0 && search.cost[i] < unknown && (node == nodes.size() || search.cost[i] < search.cost[node]))
        node = i;
    if (node == nodes.size() || (goal != nullptr && node + 1 == nodes.size())) return search;
    done[node] = 1;
    if (node < portal_count) offer(node, node ^ 1U, over_stair(stairs()[node / 2], node % 2 == 0), config_.stairs_cost);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (done[i] == 0 && nodes[i].storey == nodes[node].storey && nodes[i].storey >= 0)
        offer(node, i, walk(node, i), 1.0);
  }
}

std::vector<Waypoint> MultiStoreyPlanner::path(const FloorPoint& a, const FloorPoint& b) const {
  if (a.storey == b.storey) {
    Path direct = on_storey(a, b);
    if (!direct.empty()) return direct;
  }
  if (building_.stairs.empty()) return {};
  const Search found = search(a, &b);
  const std::size_t goal = found.cost.size() - 1;
  return found.cost[goal] < std::numeric_limits<double>::infinity() ? found.path_to(goal) : Path{};
}

std::vector<int> MultiStoreyPlanner::reachable_storeys(const FloorPoint& a) const {
  std::vector<int> storeys = {a.storey};
  if (!building_.stairs.empty()) {
    const Search found = search(a, nullptr);
    const std::vector<FloorPoint> places = portals();
    for (std::size_t i = 0; i < places.size(); ++i)
      if (found.cost[i] < std::numeric_limits<double>::infinity()) storeys.push_back(places[i].storey);
  }
  std::sort(storeys.begin(), storeys.end());
  storeys.erase(std::unique(storeys.begin(), storeys.end()), storeys.end());
  return storeys;
}

}  // namespace plumbline::sim
