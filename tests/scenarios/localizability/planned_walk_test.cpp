// SPDX-License-Identifier: Apache-2.0
#include "scenarios/localizability/planned_walk.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "bim/formats/ifc/write/write_ifc.h"
#include "bim/load/load.h"
#include "tests/data.h"
#include "tests/folder.h"
#include "tests/scenarios/raised_rooms.h"

namespace plumbline::scenarios {
namespace {

namespace fs = std::filesystem;

/// A scenario file in the plan of the short run.
class Written {
 public:
  Written(const std::string& name, const std::string& more)
      : path_(fs::path(testing::TempDir()) / ("plumbline_" + name + std::to_string(::getpid()) + ".yaml")) {
    std::ofstream(path_) << "scenario: 1\nbuilding: "
                         << fs::absolute(project_file("tests/system/short.plan.yaml")).string()
                         << "\nstart: {room: left}\nroute: {rooms: [hall]}\nspeed_mps: 0.5\nduration_s: 10\n"
                         << more;
  }
  ~Written() { fs::remove(path_); }
  Written(const Written&) = delete;
  Written& operator=(const Written&) = delete;
  [[nodiscard]] std::string path() const { return path_.string(); }

 private:
  fs::path path_;
};

TEST(PlannedWalk, EndsWhereTheRobotIsCarriedOffAndGoesOnElsewhere) {
  const Written free("free", ""), taken("taken", "kidnap: {after_s: 2, away_s: 2, to: {room: right, yaw_deg: 90}}\n");
  const ResolvedScenario alone = resolve(free.path(), {});
  const std::vector<TruthSample> whole = planned_walk(alone);
  EXPECT_TRUE(planned_walk_after(alone).empty());
  const ResolvedScenario resolved = resolve(taken.path(), {});
  const std::vector<TruthSample> before = planned_walk(resolved), after = planned_walk_after(resolved);
  ASSERT_FALSE(before.empty());
  ASSERT_FALSE(after.empty());
  const double step_s = 0.1 / 0.5;  // samples stand 0.1 m apart
  EXPECT_LE(before.back().t_s, 2.0 + step_s);
  ASSERT_LT(before.size(), whole.size());
  EXPECT_EQ(before.back().X_WR.t, whole[before.size() - 1].X_WR.t);
  EXPECT_EQ(after.front().t_s, 0.0);
  EXPECT_EQ(after.front().X_WR.t.head<2>(), resolved.world_after->start_W);
  EXPECT_LE(after.back().t_s, 10.0 - before.back().t_s - 2.0 + step_s);
}

TEST(PlannedWalk, AnswersSayWhatIsKnownBeforeAndAfter) {
  const Written free("free", ""), taken("taken", "kidnap: {after_s: 2, away_s: 2, to: {room: right, yaw_deg: 90}}\n");
  const std::vector<SeedAnswers> alone = localizability_of_walks(free.path(), 1, 1),
                                 both = localizability_of_walks(taken.path(), 1, 1);
  ASSERT_EQ(both.size(), 1U);
  EXPECT_FALSE(alone.front().building.set_down);
  ASSERT_TRUE(both.front().building.set_down);
  EXPECT_EQ(walks_text(alone).find("set down"), std::string::npos);
  EXPECT_NE(walks_text(both).find("set down"), std::string::npos);
  EXPECT_NE(walks_json(both).find("walks")->as_list().front().find("set_down"), nullptr);
  EXPECT_EQ(summary_of(both, WalkPart::set_down).walks, 1);
  EXPECT_EQ(summary_of(alone, WalkPart::set_down).walks, 0);
}

/// The heights of a route are rounded.
TEST(PlannedWalk, OnARaisedFloorItsScansAreTakenAtTheHeightOfTheFloor) {
  const Folder folder;
  const std::string name = folder / "raised";
  bim::Building plan = bim::load_building(project_file("tests/system/short.plan.yaml"));
  raise_rooms(plan, 0.235);
  std::ofstream(name + ".ifc") << bim::write_ifc(plan);
  std::ofstream(name + ".yaml") << "scenario: 1\nbuilding: " + name +
                                       ".ifc\nstart: {room: left}\nroute: {rooms: [hall]}\nspeed_mps: 0.5\n";
  const ResolvedScenario resolved = resolve(name + ".yaml", {});
  const std::vector<TruthSample> walk = planned_walk(resolved);
  ASSERT_FALSE(walk.empty());
  const SearchArea area = search_area(resolved.building->as_planned(), 0);
  EXPECT_NEAR(area.sensor_z_W(walk.front().X_WR.t.head<2>()) - area.floors.ground_m, 0.895, 1e-6);
  for (const TruthSample& sample : walk)
    EXPECT_EQ(sample.sensor_z_W, area.sensor_z_W(sample.X_WR.t.head<2>())) << sample.X_WR.t.transpose();
}

}  // namespace
}  // namespace plumbline::scenarios
