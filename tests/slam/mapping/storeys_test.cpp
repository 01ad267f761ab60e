// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "slam/mapping/s_graphs_plus.h"
#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

// Up a flight of stairs into a room that looks like the one below and lies over it: one graph, two floors, and nothing
// that ties the one to the other but the way between.
TEST(SGraphsPlus, StoreysThatLookAlikeLiveInOneGraph) {
  synthetic::WalkConfig walk;
  walk.speed_mps = 1.2;
  walk.climb = synthetic::two_storeys_climb;
  const synthetic::Recording recording = synthetic::walk(synthetic::two_storeys(), synthetic::two_storeys_walk(), walk);
  MethodInput input;
  input.calibration = recording.calibration;
  SGraphsPlus method(input, {});
  std::size_t next = 0;
  for (const Scan& scan : recording.scans) {
    for (; next < recording.odometry.size() && recording.odometry[next].stamp <= scan.stamp; ++next)
      method.on_odometry(recording.odometry[next]);
    (void)method.on_scan(scan);
  }
  const Estimate estimate = method.finish();
  const Graph& graph = method.graph();

  const auto storey = [&](int keyframe) { return graph.keyframes[static_cast<std::size_t>(keyframe)].storey; };
  EXPECT_EQ(graph.keyframes.front().storey, 0);
  EXPECT_EQ(graph.keyframes.back().storey, 1);
  for (const PlaneFactor& f : graph.plane_factors)
    EXPECT_EQ(storey(f.keyframe), graph.planes[static_cast<std::size_t>(f.plane)].storey);
  for (const PoseFactor& f : graph.pose_factors)
    EXPECT_TRUE(!f.loop || storey(f.from) == storey(f.to)) << f.from << " to " << f.to;
  for (const RoomFactor& f : graph.room_factors)
    for (const int plane : f.planes)
      EXPECT_EQ(graph.rooms[static_cast<std::size_t>(f.room)].storey,
                graph.planes[static_cast<std::size_t>(plane)].storey);

  ASSERT_EQ(estimate.floors.size(), 2U);
  // Over sixteen treads at 1.2 m/s the odometry's height was 0.3 m off; storeys are told apart by 1.8 m.
  EXPECT_NEAR(estimate.floors[1].center_F.z() - estimate.floors[0].center_F.z(), 3.0, 0.6);
  std::set<int> of_room;
  for (const RoomNode& room : estimate.rooms)
    if (std::abs(std::abs(signed_area(room.polygon_F)) - 24.0) < 1.5)
      of_room.insert(graph.rooms[static_cast<std::size_t>(room.id)].storey);
  EXPECT_EQ(of_room, (std::set<int>{0, 1})) << "the room is found on either storey";
}

}  // namespace
}  // namespace plumbline::slam
