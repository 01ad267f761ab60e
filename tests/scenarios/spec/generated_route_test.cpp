// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scenarios/spec/route_plan.h"
#include "sim/route/route.h"
#include "tests/bim/generators/option_sweep.h"

namespace plumbline::scenarios {
namespace {

constexpr std::uint64_t sweep = 240;  ///< the buildings of bim's Families test

/// Solid part of a wall as seen from above: from s0 to s1 along it.
struct Piece {
  const bim::Wall* wall = nullptr;
  double s0 = 0.0;
  double s1 = 0.0;

  [[nodiscard]] double distance(const Eigen::Vector2d& p) const {
    const double s = wall->direction().dot(p - wall->a), t = wall->left().dot(p - wall->a);
    const double along = std::max({s0 - s, 0.0, s - s1});
    const double across = std::max({wall->offset_m - t, 0.0, t - wall->offset_m - wall->thickness_m});
    return std::hypot(along, across);
  }
};

/// What is left of the walls of a storey between the doors that stand open.
std::vector<Piece> pieces_of(const bim::Building& building, int storey) {
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < building.walls.size(); ++i) {
    const bim::Wall& wall = building.walls[i];
    if (wall.storey != storey) continue;
    std::vector<std::pair<double, double>> gaps;
    for (const bim::Opening& o : building.openings)
      if (o.wall == static_cast<int>(i) && o.kind != bim::OpeningKind::window && o.leaf != bim::Leaf::closed)
        gaps.emplace_back(o.s_m - 0.5 * o.width_m, o.s_m + 0.5 * o.width_m);
    std::sort(gaps.begin(), gaps.end());
    double s = 0.0;
    for (const auto& [s0, s1] : gaps) {
      pieces.push_back({&wall, s, s0});
      s = s1;
    }
    pieces.push_back({&wall, s, wall.length()});
  }
  return pieces;
}

/// Least distance of a way on one storey to its walls and columns, sampled every 5 cm.
double least_clearance(const bim::Building& building, int storey, const std::vector<sim::Waypoint>& way) {
  const std::vector<Piece> pieces = pieces_of(building, storey);
  double least = 1e9;
  for (std::size_t i = 1; i < way.size(); ++i) {
    const Eigen::Vector2d a = way[i - 1].p_W.head<2>(), b = way[i].p_W.head<2>();
    const int count = 1 + static_cast<int>((b - a).norm() / 0.05);
    for (int k = 0; k <= count; ++k) {
      const Eigen::Vector2d p = a + (b - a) * (static_cast<double>(k) / count);
      for (const Piece& piece : pieces) least = std::min(least, piece.distance(p));
      for (const bim::Column& column : building.columns)
        if (column.storey == storey)
          least = std::min(least, contains(column.footprint, p) ? 0.0 : boundary_distance(column.footprint, p));
    }
  }
  return least;
}

bool passes(const std::vector<sim::Waypoint>& way, const Polygon2& room) {
  return std::any_of(way.begin(), way.end(),
                     [&](const sim::Waypoint& w) { return contains(room, Eigen::Vector2d(w.p_W.head<2>())); });
}

TEST(GeneratedRoute, ReachesEveryRoomOfEveryStoreyAndKeepsClearOfTheWalls) {
  // Half a cell of planning and half a cell of bilinear clearance may be missing.
  const sim::RouteConfig config;
  const double wanted = config.radius_m - config.cell_m;
  std::size_t buildings = 0, rooms = 0;
  for (std::uint64_t k = 0; k < sweep; ++k) {
    const std::optional<bim::SweepCase> c = bim::sweep_case(k);
    if (!c) continue;
    ++buildings;
    for (int s = 0; s < static_cast<int>(c->building.storeys.size()); ++s) {
      Start start;
      Route route;
      route.rooms.clear();
      for (const bim::Room& room : c->building.rooms) {
        if (room.storey != s) continue;
        if (!start.room) start.room = room.id;
        route.rooms.push_back(room.id);
      }
      rooms += route.rooms.size();
      RoutePlan plan;
      ASSERT_NO_THROW(plan = plan_route(c->building, start, route, {})) << c->what;
      EXPECT_GE(least_clearance(c->building, s, plan.waypoints), wanted) << c->what;
      for (const bim::Room& room : c->building.rooms)
        EXPECT_TRUE(room.storey != s || passes(plan.waypoints, room.polygon)) << c->what << room.id;
    }
  }
  EXPECT_GE(buildings, 200U);
  EXPECT_GE(rooms, 1500U);
}

TEST(GeneratedRoute, AnotherStoreyWithoutAStairIsRefusedInOneLine) {
  Tree options = Tree::map();
  const bim::GeneratedPlan generated = bim::generate("storeys", options);
  const bim::Building tower = bim::read_plan_text(bim::write_plan(generated.plan), "tower");
  const auto room_of = [&](int storey) {
    return std::find_if(tower.rooms.begin(), tower.rooms.end(), [&](const auto& r) { return r.storey == storey; })->id;
  };
  Start start;
  start.room = room_of(0);
  Route route;
  route.rooms = {room_of(1)};
  try {
    (void)plan_route(tower, start, route, {});
    FAIL() << "no error";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("'" + room_of(1) + "' cannot be reached"), std::string::npos) << message;
    EXPECT_NE(message.find("the building has no stairs"), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace plumbline::scenarios
