// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "bim/load/load.h"
#include "sim/route/route.h"
#include "tests/data.h"

namespace plumbline::sim {
namespace {

class QuickstartRoutes : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string path = project_file("scenarios/library/quickstart.plan.yaml");
    ASSERT_TRUE(std::filesystem::exists(path)) << path;
    building_ = bim::load_building(path);
    for (const bim::Column& column : building_.columns) solids_.push_back(column.footprint);
    for (const bim::Obstacle& obstacle : building_.obstacles) {
      // Upright prisms: their walls stand on their lowest vertices, in order around.
      Polygon2 base;
      for (const Eigen::Vector3d& v : obstacle.body.vertices)
        if (v.z() < 0.05) base.emplace_back(v.head<2>());
      if (base.size() >= 3) solids_.push_back(base);
    }
    ASSERT_GE(solids_.size(), 7U);
  }

  bim::Building building_;
  std::vector<Polygon2> solids_;  ///< everything but the walls
};

TEST_F(QuickstartRoutes, EveryRoomIsReachedFromEveryOther) {
  const ClearanceMap space(building_, 0);
  ASSERT_GE(building_.rooms.size(), 7U);
  std::vector<Eigen::Vector2d> targets;
  for (const bim::Room& room : building_.rooms) {
    const auto target = space.room_targets(room);
    ASSERT_EQ(target.size(), 1U) << room.id;
    targets.push_back(target[0]);
  }
  for (const Eigen::Vector2d& a : targets) {
    for (const Eigen::Vector2d& b : targets) {
      const std::vector<Eigen::Vector2d> path = space.path(a, b);
      ASSERT_GE(path.size(), 2U);
      EXPECT_LE(path.size(), 12U);
      for (std::size_t i = 1; i < path.size(); ++i) {
        for (int k = 0; k <= 100; ++k) {
          const Eigen::Vector2d p = path[i - 1] + (path[i] - path[i - 1]) * (k / 100.0);
          EXPECT_TRUE(space.free(p)) << p.transpose();
          // Half a cell of planning and half a cell of bilinear clearance.
          for (const Polygon2& solid : solids_) EXPECT_GE(boundary_distance(solid, p), 0.40 - 0.05);
        }
      }
    }
  }
}

TEST_F(QuickstartRoutes, AreTheSameTwice) {
  const ClearanceMap first(building_, 0);
  const ClearanceMap second(building_, 0);
  const Eigen::Vector2d a = first.room_targets(building_.rooms.front()).at(0);
  const Eigen::Vector2d b = first.room_targets(building_.rooms.back()).at(0);
  EXPECT_EQ(first.path(a, b), second.path(a, b));
  EXPECT_EQ(first.path(a, b), first.path(a, b));
}

}  // namespace
}  // namespace plumbline::sim
