// SPDX-License-Identifier: Apache-2.0
#include "slam/io/bags/building_view.h"

#include <gtest/gtest.h>

#include <cstring>

namespace plumbline::slam::ros {
namespace {

/// A wall of 0.2 m along x from 0 to 4, at y from 2.02 to 2.22, up to 3 m; rooms below and above it.
struct TwoRooms {
  bim::BuildingMesh mesh;
  bim::Plan plan;

  TwoRooms() {
    const double x[2] = {0.0, 4.0}, y[2] = {2.02, 2.22}, z[2] = {0.0, 3.0};
    for (int i = 0; i < 8; ++i) mesh.vertices.emplace_back(x[i & 1], y[(i >> 1) & 1], z[(i >> 2) & 1]);
    for (const Eigen::Vector3i& t :
         {Eigen::Vector3i(0, 1, 5), Eigen::Vector3i(0, 5, 4), Eigen::Vector3i(2, 3, 7), Eigen::Vector3i(2, 7, 6),
          Eigen::Vector3i(0, 2, 6), Eigen::Vector3i(0, 6, 4), Eigen::Vector3i(1, 3, 7), Eigen::Vector3i(1, 7, 5)}) {
      mesh.triangles.push_back(t);
      mesh.element.push_back(0);
    }
    mesh.elements.emplace_back();
    plan.storeys.emplace_back();
    for (const double low : {0.02, 2.22}) {
      bim::PlanRoom room;
      room.storey = 0;
      room.polygon = {{0.0, low}, {4.0, low}, {4.0, low + 2.0}, {0.0, low + 2.0}};
      plan.rooms.push_back(room);
    }
  }
};

std::int8_t cell_at(const Grid& grid, double x, double y) {
  const auto column = static_cast<std::size_t>((x - grid.origin.x()) / static_cast<double>(grid.resolution_m));
  const auto row = static_cast<std::size_t>((y - grid.origin.y()) / static_cast<double>(grid.resolution_m));
  return grid.cells.at(row * grid.width + column);
}

TEST(BuildingView, CutsThePlan) {
  const TwoRooms rooms;
  const BuildingView view = building_view(rooms.mesh, rooms.plan, 0);
  ASSERT_EQ(view.parts.size(), 1U);
  EXPECT_EQ(view.parts[0].name, "walls");
  EXPECT_EQ(view.parts[0].corners.size(), 24U);
  const Grid& grid = view.plan;
  EXPECT_EQ(grid.frame, "map");
  EXPECT_EQ(grid.width, 100U);   // 4 m and half a metre on each side
  EXPECT_EQ(grid.height, 105U);  // 4.2 m and the same
  EXPECT_NEAR(grid.origin.x(), -0.5, 1e-6);
  EXPECT_EQ(cell_at(grid, 2.0, 1.0), 0);  // rooms
  EXPECT_EQ(cell_at(grid, 2.0, 3.2), 0);
  EXPECT_EQ(cell_at(grid, 2.0, 2.03), 100);  // the wall's faces
  EXPECT_EQ(cell_at(grid, 2.0, 2.21), 100);
  EXPECT_EQ(cell_at(grid, 2.0, 2.11), -1);  // what is in it
  EXPECT_EQ(cell_at(grid, -0.3, 1.0), -1);  // outside
}

TEST(BuildingView, HasNoPlanWithoutRooms) {
  TwoRooms rooms;
  EXPECT_TRUE(building_view(rooms.mesh, rooms.plan, -1).plan.cells.empty());
  EXPECT_TRUE(building_view(rooms.mesh, rooms.plan, 7).plan.cells.empty());
  rooms.plan.rooms[1].polygon[2].x() = 1e6;  // too many cells
  EXPECT_TRUE(building_view(rooms.mesh, rooms.plan, 0).plan.cells.empty());
  rooms.plan.rooms.clear();
  EXPECT_TRUE(building_view(rooms.mesh, rooms.plan, 0).plan.cells.empty());
}

TEST(BuildingView, MessagesAreAsLongAsTheirLayout) {
  const TwoRooms rooms;
  const BuildingView view = building_view(rooms.mesh, rooms.plan, 0);
  const Bytes grid = write_grid(view.plan, Encoding::cdr);
  // Head, stamp, "map", load time, resolution and sizes (4-byte aligned: 4 + 8 + 4 + 4 + 8 + 12 = 40), pose from a
  // multiple of 8 on after the head, count, cells.
  EXPECT_EQ(grid.size(), 4U + 40U + 56U + 4U + view.plan.cells.size());
  const Bytes markers = write_markers(view.parts, "map", Encoding::cdr);
  std::uint32_t count = 0;
  std::memcpy(&count, &markers[4], sizeof count);
  EXPECT_EQ(count, 1U);
  EXPECT_GT(markers.size(), 24U * 24U);
  EXPECT_LT(markers.size(), 24U * 24U + 300U);
}

}  // namespace
}  // namespace plumbline::slam::ros
