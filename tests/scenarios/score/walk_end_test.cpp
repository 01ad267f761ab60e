// SPDX-License-Identifier: Apache-2.0
#include "scenarios/score/walk_end.h"

#include <gtest/gtest.h>

#include "tests/sim/route/floor_plan.h"

namespace plumbline::scenarios::score {
namespace {

/// A walk from west to east that ended at `end`, at a time of 30 s at most, `walked_m` after its begin.
FinishedRun walk_that_ended(const Eigen::Vector2d& end, double at_s, double walked_m = 20.0) {
  bim::Building building = sim::two_rooms();
  sim::add_door(building, 0, 2.5, 0.9);
  FinishedRun run;
  run.building = std::make_shared<const RunBuilding>(bim::PlannedAndBuilt{building, building, {}, true});
  run.scenario.duration_s = 30.0;
  run.walk.rooms = run.walk.in_reach = run.walk.on_route = 2;
  run.walk.planned_m = 20.0;
  run.walk.route_rooms = {"east"};
  run.walk.end_W = {6.0, 2.5};
  run.record.truth_W = {{0, Pose::from_xyz_yaw({end.x() - walked_m, end.y(), 0.5}, 0.0)},
                        {static_cast<slam::Nanoseconds>(at_s * 1e9), Pose::from_xyz_yaw({end.x(), end.y(), 0.5}, 0.0)}};
  return run;
}

TEST(WalkEnd, ATimeThatWasUpSaysWhatWasLeftAndWhatWouldDo) {
  const std::vector<std::string> warnings = warnings_of_walk(walk_that_ended({2.0, 2.5}, 29.9));
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings.front(),
            "the walk ended when its time was up (30 s), before it came to east; `duration_s: 80` would do for all of "
            "its route");
}

TEST(WalkEnd, DurationsAreSaidInTenths) {
  FinishedRun run = walk_that_ended({2.0, 2.5}, 29.9);
  run.scenario.duration_s = 10.600000000000001;
  EXPECT_EQ(warnings_of_walk(run).front().rfind("the walk ended when its time was up (10.6 s), before", 0), 0U);
}

TEST(WalkEnd, AWalkThatIsDoneHasNothingToSay) {
  EXPECT_TRUE(warnings_of_walk(walk_that_ended({6.2, 2.5}, 29.9)).empty());
  EXPECT_TRUE(warnings_of_walk(walk_that_ended({3.8, 2.5}, 20.0)).empty()) << "the time was not up";
}

// The robot stands near the end of a round trip when it sets out.
TEST(WalkEnd, ARoundTripThatWasHardlyBegunIsNotDone) {
  const std::vector<std::string> warnings = warnings_of_walk(walk_that_ended({6.2, 2.5}, 29.9, 0.3));
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings.front(),
            "the walk ended when its time was up (30 s); `duration_s: 80` would do for all of its route");
}

TEST(WalkEnd, WithoutWallsItIsSaidThatTheyAreNotScored) {
  FinishedRun run = walk_that_ended({6.2, 2.5}, 29.9);
  bim::Building open = run.building->variants().as_built;
  open.walls.clear();
  open.openings.clear();
  run.building = std::make_shared<const RunBuilding>(bim::PlannedAndBuilt{open, open, {}, true});
  EXPECT_EQ(warnings_of_walk(run),
            std::vector<std::string>{"no walls are known in the building: `walls.*` are not scored"});
}

}  // namespace
}  // namespace plumbline::scenarios::score
