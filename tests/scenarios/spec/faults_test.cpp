// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/faults.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <numbers>

#include "scenarios/spec/resolve.h"
#include "tests/data.h"
#include "tests/folder.h"
#include "tests/input_error.h"

namespace plumbline::scenarios {
namespace {

const std::string plain = "scenario: 1\nbuilding: short.plan.yaml\n";

Scenario with(const std::string& more) { return read_scenario(plain + more, "s.yaml").scenario; }
std::string error_of(const std::string& more) {
  return input_error([&] { static_cast<void>(with(more)); });
}

TEST(FaultsSpec, NothingIsWrongAndNothingIsWrittenUnlessAskedFor) {
  const Scenario scenario = with("");
  EXPECT_FALSE(scenario.faults);
  const std::string text = write_scenario(scenario);
  EXPECT_EQ(text.find("faults"), std::string::npos);
  EXPECT_EQ(text.find("bias_m"), std::string::npos);
  const sim::Faults none = faults(scenario.faults);
  EXPECT_EQ(none.clock.offset_s, 0.0);
  EXPECT_EQ(none.slip.speed_mps, 0.0);
  EXPECT_TRUE(off_defaults(scenario).empty());
}

TEST(FaultsSpec, SizesReplaceThoseOfThePreset) {
  const sim::Faults harsh = faults(with("faults: {preset: harsh}\n").faults);
  EXPECT_EQ(harsh.clock.offset_s, sim::faults_of(sim::FaultsPreset::harsh).clock.offset_s);
  const Scenario scenario = with("faults: {preset: harsh, clock_offset_s: -0.08, mount_error_deg: 2, slip_mps: 0}\n");
  const sim::Faults some = faults(scenario.faults);
  EXPECT_EQ(some.clock.offset_s, -0.08);
  EXPECT_EQ(some.clock.jitter_s, harsh.clock.jitter_s);
  EXPECT_DOUBLE_EQ(some.mount.angle_rad, 2.0 * std::numbers::pi / 180.0);
  EXPECT_EQ(some.slip.speed_mps, 0.0);
  const sim::Faults one = faults(with("faults: {gyro_bias_radps: 0.01}\n").faults);
  EXPECT_EQ(one.imu.gyro_bias, 0.01);
  EXPECT_EQ(one.clock.offset_s, 0.0);
  const std::vector<std::string> off = off_defaults(scenario);
  for (const char* name : {"faults.preset: harsh", "faults.clock_offset_s: -0.08", "faults.slip_mps: 0"})
    EXPECT_NE(std::find(off.begin(), off.end(), name), off.end()) << name;
  EXPECT_EQ(write_scenario(read_scenario(write_scenario(scenario), "s.yaml").scenario), write_scenario(scenario));
}

TEST(FaultsSpec, LidarSizesReplaceThoseOfThePreset) {
  const sim::LidarConfig harsh = lidar_config(with("lidar: {preset: harsh}\n").lidar);
  EXPECT_GT(harsh.distance_bias_m, 0.0);
  EXPECT_TRUE(harsh.range_noise);
  const sim::LidarConfig some =
      lidar_config(with("lidar: {airborne_per_m: 0.1, warm_up_m: 0.2, warm_up_s: 9}\n").lidar);
  EXPECT_EQ(some.airborne_per_m, 0.1);
  EXPECT_EQ(some.warm_up_m, 0.2);
  EXPECT_EQ(some.warm_up_s, 9.0);
  EXPECT_EQ(some.distance_bias_m, 0.0);
}

TEST(FaultsSpec, ComplaintsNameThePlace) {
  EXPECT_NE(error_of("faults: {mount_offset_m: [1, 0]}\n").find("s.yaml:3:"), std::string::npos);
  EXPECT_NE(error_of("faults: {mount_offset_m: [1, 0]}\n").find("3 numbers"), std::string::npos);
  EXPECT_NE(error_of("faults: {slip_s: 4}\n").find("a third"), std::string::npos);
  EXPECT_NE(error_of("faults: {clock_ofset_s: 4}\n").find("'clock_offset_s'"), std::string::npos);
  EXPECT_NE(error_of("faults: {mount_rotation_deg: [0, 0, 90]}\n"), "no error");
  EXPECT_NE(error_of("lidar: {airborne_per_m: -1}\n"), "no error");
}

TEST(FaultsSpec, MethodsAreToldAMountThatIsOffAndTheWorldKeepsTheTrueOne) {
  const Folder folder;
  std::filesystem::copy_file(project_file("tests/system/short.plan.yaml"), folder / "short.plan.yaml");
  std::ofstream(folder / "s.yaml") << plain << "start: {room: left}\nroute: {rooms: [hall]}\n";
  std::ofstream(folder / "off.yaml") << plain << "start: {room: left}\nroute: {rooms: [hall]}\n"
                                     << "faults: {mount_error_m: 0.02, mount_error_deg: 1}\n";
  const slam::Calibration truth = sim::World::calibration();
  EXPECT_EQ(resolve(folder / "s.yaml", {}).calibration.X_RL.t, truth.X_RL.t);
  const ResolvedScenario one = resolve(folder / "off.yaml", {}),
                         other = resolve(folder / "off.yaml", {std::nullopt, 2});
  EXPECT_NEAR((one.calibration.X_RL.t - truth.X_RL.t).norm(), 0.02, 1e-12);
  EXPECT_NEAR(one.calibration.X_RL.q.angularDistance(truth.X_RL.q), std::numbers::pi / 180.0, 1e-9);
  EXPECT_GT((one.calibration.X_RL.t - other.calibration.X_RL.t).norm(), 1e-4);
  EXPECT_EQ(sim::World::calibration().X_RL.t, truth.X_RL.t);
}

}  // namespace
}  // namespace plumbline::scenarios
