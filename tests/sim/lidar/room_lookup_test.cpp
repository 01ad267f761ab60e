// SPDX-License-Identifier: Apache-2.0
#include "sim/lidar/room_lookup.h"

#include <gtest/gtest.h>

#include <array>

#include "bim/geometry/polygon.h"
#include "bim/random/stream.h"

namespace plumbline::sim {
namespace {

bim::Room room(Polygon2 polygon, double z0) {
  bim::Room out;
  out.polygon = std::move(polygon);
  out.z0_m = z0;
  out.z1_m = z0 + 2.8;
  return out;
}

TEST(RoomLookup, FindsTheRoomOfEveryPoint) {
  bim::Building building;
  building.rooms.push_back(room({{0, 0}, {4, 0}, {4, 3}, {2, 3}, {2, 6}, {0, 6}}, 0.0));
  building.rooms.push_back(room({{2.1, 3.1}, {6, 3.1}, {5, 7}, {2.1, 6}}, 0.0));
  building.rooms.push_back(room({{0, 0}, {6, 0}, {6, 7}, {0, 7}}, 3.0));
  const RoomLookup lookup(building);
  const Stream stream(11, "bim.generate");
  std::array<int, 4> found{};
  for (std::uint64_t i = 0; i < 20000; ++i) {
    const Eigen::Vector3d p(-1.0 + 9.0 * stream.uniform(i, 0), -1.0 + 9.0 * stream.uniform(i, 1),
                            -1.0 + 8.0 * stream.uniform(i, 2));
    std::int32_t expected = -1;
    for (std::size_t r = building.rooms.size(); r-- > 0;)
      if (p.z() >= building.rooms[r].z0_m - 0.1 && p.z() <= building.rooms[r].z1_m + 0.1 &&
          contains(building.rooms[r].polygon, p.head<2>()))
        expected = static_cast<std::int32_t>(r);
    EXPECT_EQ(lookup.at(p), expected) << p.transpose();
    ++found[static_cast<std::size_t>(expected + 1)];
  }
  for (const int count : found) EXPECT_GT(count, 500);
}

TEST(RoomLookup, ABuildingWithoutRoomsHasNone) {
  const bim::Building building;
  EXPECT_EQ(RoomLookup(building).at({1.0, 1.0, 1.0}), -1);
}

}  // namespace
}  // namespace plumbline::sim
