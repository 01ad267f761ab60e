// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "scenarios/route_plan.h"
#include "tests/bim/families/sweep.h"

namespace plumbline::scenarios {
namespace {

constexpr std::uint64_t sweep = 240;  ///< the buildings of bim's Families test

TEST(GeneratedRoute, ReachesEveryRoomOfEveryStorey) {
  std::size_t buildings = 0, rooms = 0;
  for (std::uint64_t k = 0; k < sweep; ++k) {
    const std::optional<bim::SweepCase> c = bim::sweep_case(k);
    if (!c) continue;
    ++buildings;
    for (std::size_t s = 0; s < c->building.storeys.size(); ++s) {
      Start start;
      Route route;
      route.rooms.clear();
      for (const bim::Room& room : c->building.rooms) {
        if (room.storey != static_cast<int>(s)) continue;
        if (!start.room) start.room = room.id;
        route.rooms.push_back(room.id);
      }
      rooms += route.rooms.size();
      EXPECT_NO_THROW((void)plan_route(c->building, start, route, {})) << c->what;
    }
  }
  EXPECT_GE(buildings, 200U);
  EXPECT_GE(rooms, 1500U);
}

}  // namespace
}  // namespace plumbline::scenarios
