// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/scenario.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/input_error.h"

namespace plumbline::scenarios {
namespace {

const std::string good = R"(scenario: 1
name: test
building: two.plan.yaml
seed: 7
start: {storey: ground, at: [1.5, 2], yaw_deg: 90}
route: {rooms: all, loop: 2}
speed_mps: 0.5
duration_s: 30
lidar: {model: vlp16, preset: ideal}
odometry: {preset: uncorrected}
prior: {yaw: known, storey: unknown}
methods: [vgicp]
gates:
  - {metric: ate_aligned_rmse_m, method: vgicp, max: 0.25}
  - {metric: rooms.recall, method: vgicp, min: 0.8}
)";

std::string error_of(const std::string& text) {
  return input_error([&] { static_cast<void>(read_scenario(text, "s.yaml")); });
}

std::string with(const std::string& from, const std::string& to) {
  std::string text = good;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(Scenario, ReadsEveryField) {
  const Scenario scenario = read_scenario(good, "s.yaml").scenario;
  EXPECT_EQ(scenario.seed, 7U);
  EXPECT_EQ(*scenario.start.at, Eigen::Vector2d(1.5, 2.0));
  EXPECT_EQ(scenario.route.rooms, std::vector<std::string>{"all"});
  EXPECT_EQ(scenario.route.loop, 2);
  EXPECT_EQ(scenario.lidar.preset, sim::LidarPreset::ideal);
  EXPECT_EQ(scenario.prior.yaw, Knowledge::known);
  ASSERT_EQ(scenario.gates.size(), 2U);
  EXPECT_EQ(*scenario.gates[1].min, 0.8);
  EXPECT_EQ(off_defaults(scenario), (std::vector<std::string>{"lidar.preset: ideal", "odometry.preset: uncorrected"}));
}

TEST(Scenario, GroundAndPushesBecomeConditions) {
  const sim::Conditions usual = conditions({}, {});
  EXPECT_EQ(usual.friction, 0.8);
  EXPECT_EQ(usual.terrain_noise_m, 0.0);
  EXPECT_EQ(usual.pushes.max_n, 0.0);
  const std::string text =
      std::string(good) + "ground: {friction: 0.4, uneven_mm: 15}\npushes: {max_n: 100, every_s: 4}\n";
  const Scenario scenario = read_scenario(text, "s.yaml").scenario;
  const sim::Conditions hard = conditions(scenario.ground, scenario.pushes);
  EXPECT_EQ(hard.friction, 0.4);
  EXPECT_DOUBLE_EQ(hard.terrain_noise_m, 0.015);
  EXPECT_DOUBLE_EQ(hard.pushes.min_n, 30.0);
  EXPECT_EQ(hard.pushes.max_n, 100.0);
  EXPECT_EQ(hard.pushes.every_s, 4.0);
  EXPECT_FALSE(hard.pushes.on_stairs);
  EXPECT_EQ(write_scenario(read_scenario(write_scenario(scenario), "s.yaml").scenario), write_scenario(scenario));
  const std::vector<std::string> off = off_defaults(scenario);
  for (const char* name : {"ground.friction: 0.4", "ground.uneven_mm: 15", "pushes.max_n: 100", "pushes.every_s: 4"})
    EXPECT_NE(std::find(off.begin(), off.end(), name), off.end()) << name;
}

TEST(Scenario, PeopleAndMovingDoorsAreOffTheDefaults) {
  const std::string text =
      std::string(good) + "people: [{rooms: [hall]}, {rooms: [hall]}]\nmoving_doors: [{door: d}]\n";
  const std::vector<std::string> off = off_defaults(read_scenario(text, "s.yaml").scenario);
  ASSERT_GE(off.size(), 2U);
  EXPECT_EQ(off[off.size() - 2], "people: 2");
  EXPECT_EQ(off.back(), "moving_doors: 1");
}

TEST(Scenario, MoreBodiesThanTheLidarTakesAreRefusedWhereTheyStand) {
  std::string text = std::string(good) + "moving_doors: [{door: d}]\npeople:\n";
  for (int i = 0; i < 255; ++i) text += "  - {rooms: [hall]}\n";
  EXPECT_EQ(error_of(text), "no error");
  EXPECT_NE(error_of(text + "  - {rooms: [hall]}\n").find("s.yaml:16:16: people and moving doors"), std::string::npos);
  for (int i = 0; i < 3; ++i) text += "  - {rooms: [hall]}\n";
  EXPECT_NE(error_of(text).find("at most 256, not 259"), std::string::npos);
  EXPECT_NE(error_of(text).find("s.yaml:274:5"), std::string::npos);
}

TEST(Scenario, PushesAndGroundOutOfRangeAreRefused) {
  const std::string text(good);
  EXPECT_NE(error_of(text + "pushes: {min_n: 90, max_n: 80}\n").find("min_n must not be greater"), std::string::npos);
  EXPECT_NE(error_of(text + "pushes: {max_n: -1}\n"), "no error");
  EXPECT_NE(error_of(text + "pushes: {every_s: 0}\n"), "no error");
  EXPECT_NE(error_of(text + "ground: {friction: 0}\n"), "no error");
  EXPECT_NE(error_of(text + "ground: {uneven_mm: 400}\n"), "no error");
}

TEST(Scenario, WritingAndReadingIsAFixedPoint) {
  const std::string once = write_scenario(read_scenario(good, "s.yaml").scenario);
  EXPECT_EQ(write_scenario(read_scenario(once, "s.yaml").scenario), once);
}

TEST(Scenario, MarksPointIntoTheFile) {
  const Tree tree = read_scenario(good, "s.yaml").tree;
  EXPECT_EQ(mark_at(tree, {"start"}).line, 5);
  EXPECT_EQ(mark_at(tree, {"route", "rooms"}).line, 6);
  EXPECT_EQ(mark_at(tree, {"start", "room"}).line, 5);
}

TEST(Scenario, ComplaintsNameThePlaceAndWhatWouldBeRight) {
  EXPECT_EQ(error_of(good), "no error");
  EXPECT_EQ(error_of("name: x\nscenario: 1\n").rfind("s.yaml:1:1: the first key", 0), 0U);
  EXPECT_EQ(error_of(with("scenario: 1", "scenario: 2")).rfind("s.yaml:1:", 0), 0U);
  EXPECT_NE(error_of(with("speed_mps", "speed_msp")).find("s.yaml:7:"), std::string::npos);
  EXPECT_NE(error_of(with("speed_mps", "speed_msp")).find("did you mean 'speed_mps'"), std::string::npos);
  EXPECT_NE(error_of(with("seed: 7", "seed: many")).find("s.yaml:4:7"), std::string::npos);
  EXPECT_NE(error_of(with("seed: 7", "seed: -1")).find("s.yaml:4:7"), std::string::npos);
  EXPECT_NE(error_of(with("speed_mps: 0.5", "speed_mps: 5")).find("between"), std::string::npos);
  EXPECT_NE(error_of(good + "seed: 8\n").find("s.yaml:16:1: duplicate key"), std::string::npos);
  EXPECT_NE(error_of(with("preset: ideal", "preset: idael")).find("did you mean 'ideal'"), std::string::npos);
  EXPECT_NE(error_of(with("metric: rooms.recall", "metric: rooms.recal")).find("s.yaml:15:"), std::string::npos);
  EXPECT_NE(error_of(with("metric: rooms.recall", "metric: rooms.recal")).find("'rooms.recall'"), std::string::npos);
  EXPECT_NE(error_of(with("min: 0.8", "min: 0.8, max: 1")).find("either max or min"), std::string::npos);
  EXPECT_NE(error_of(with("{storey: ground", "{room: hall, storey: ground")).find("not both"), std::string::npos);
  EXPECT_NE(error_of(with("loop: 2", "shuttle: hall")).find("not both"), std::string::npos);
  EXPECT_NE(error_of(with("loop: 2", "loop: 0")).find("between"), std::string::npos);
  EXPECT_NE(error_of(with("loop: 2", "storeys: every")).find("storeys"), std::string::npos);
  EXPECT_NE(error_of(with("building: two.plan.yaml\n", "")).find("'building' is missing"), std::string::npos);
}

TEST(Scenario, AKidnappedRobotIsSetDownSomewhereBeforeTheEnd) {
  EXPECT_EQ(error_of(good + "kidnap: {after_s: 20, to: {room: hall}}\n"), "no error");
  EXPECT_NE(error_of(good + "kidnap: {after_s: 20}\n").find("'to' is missing"), std::string::npos);
  EXPECT_NE(error_of(good + "kidnap: {after_s: 20, to: {}}\n").find("s.yaml:16:"), std::string::npos);
  EXPECT_NE(error_of(good + "kidnap: {after_s: 20, to: {room: hall, random: rooms}}\n").find("exactly one"),
            std::string::npos);
  EXPECT_NE(error_of(good + "kidnap: {after_s: 28, to: {room: hall}}\n").find("duration_s"), std::string::npos);
  EXPECT_EQ(off_defaults(read_scenario(good + "kidnap: {to: {room: hall}, after_s: 9}\n", "s").scenario).back(),
            "kidnap");
}

TEST(Scenario, CountsThatTheRouteHasNoUseForAreRefused) {
  const auto route = [](const std::string& text) {
    const std::string before(good);
    const std::size_t at = before.find("route:");
    return error_of(before.substr(0, at) + "route: " + text + before.substr(before.find('\n', at)));
  };
  EXPECT_EQ(route("{rooms: [hall], loop: 3}"), "no error");
  EXPECT_EQ(route("{shuttle: hall, times: 3}"), "no error");
  EXPECT_EQ(route("{rooms: all, storeys: all}"), "no error");
  EXPECT_NE(route("{rooms: [hall], times: 3}").find("s.yaml:6:31: times is of a shuttle"), std::string::npos);
  EXPECT_NE(route("{shuttle: hall, loop: 3}").find("s.yaml:6:30: loop is of rooms"), std::string::npos);
  for (const char* other : {"rooms: [hall]", "shuttle: hall", "random: 3"})
    EXPECT_NE(route("{" + std::string(other) + ", storeys: all}").find("storeys is of `rooms: all`"), std::string::npos)
        << other;
}

TEST(Scenario, NamesThatNoFolderCanHaveAreRefused) {
  const std::string text = "scenario: 1\nname: ";
  EXPECT_EQ(error_of(text + std::string(100, 'n') + "\nbuilding: b.ifc\n"), "no error");
  EXPECT_NE(error_of(text + std::string(500, 'n') + "\nbuilding: b.ifc\n").find("s.yaml:2:7: a name of 500 letters"),
            std::string::npos);
}

TEST(Scenario, AShuttleIsReadAgainAsItIsWritten) {
  Scenario scenario;
  scenario.building = "two.plan.yaml";
  scenario.route.shuttle = "hall";
  scenario.route.rooms.clear();
  EXPECT_EQ(read_scenario(write_scenario(scenario), "s.yaml").scenario.route.shuttle, "hall");
}

}  // namespace
}  // namespace plumbline::scenarios
