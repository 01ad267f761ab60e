// SPDX-License-Identifier: Apache-2.0
// The sizes of the presets harsh in docs/methods, from which ci/full takes them, are those of the program.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "scenarios/spec/scenario.h"
#include "tests/data.h"

namespace plumbline {
namespace {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, separator);) parts.push_back(part);
  return parts;
}

/// A block of a scenario with each key and size of the table whose last column is `harsh`: "lidar: {warm_up_m: 1,
/// …}\n".
std::string documented(const std::string& block, const std::string& page) {
  std::ifstream in(project_file("docs/methods/" + page));
  std::string text;
  bool in_table = false;
  for (std::string line; std::getline(in, line);) {
    if (in_table && !line.starts_with('|')) break;
    const std::vector<std::string> cells = split(line, '|');
    if (!in_table) in_table = cells.size() == 4 && cells[1] == " key " && cells[3] == " `harsh` ";
    if (!in_table || cells.size() != 4 || !cells[1].starts_with(" `")) continue;
    const std::vector<std::string> keys = split(cells[1], ','), sizes = split(cells[3], ',');
    double size = 0.0;
    for (std::size_t i = 0; i < keys.size() && i < sizes.size(); ++i)
      if (std::istringstream(sizes[i]) >> size) {
        std::ostringstream entry;
        entry << (text.empty() ? "" : ", ") << split(keys[i], '`').at(1) << ": " << size;
        text += entry.str();
      }
  }
  return block + ": {" + text + "}\n";
}

scenarios::Scenario scenario_with(const std::string& block) {
  return scenarios::read_scenario("scenario: 1\nbuilding: b.plan.yaml\n" + block, "s.yaml").scenario;
}

TEST(HarshSizes, OfTheLidarAreThoseOfThePreset) {
  const std::string block = documented("lidar", "lidar_model.md");
  const sim::LidarConfig told = lidar_config(scenario_with(block).lidar),
                         harsh = lidar_config(scenario_with("lidar: {preset: harsh}\n").lidar);
  EXPECT_EQ(told.distance_bias_m, harsh.distance_bias_m) << block;
  EXPECT_EQ(told.reflectivity_bias_m, harsh.reflectivity_bias_m) << block;
  EXPECT_EQ(told.incidence_bias_m, harsh.incidence_bias_m) << block;
  EXPECT_EQ(told.warm_up_m, harsh.warm_up_m) << block;
  EXPECT_EQ(told.warm_up_s, harsh.warm_up_s) << block;
  EXPECT_EQ(told.airborne_per_m, harsh.airborne_per_m) << block;
  EXPECT_GT(told.distance_bias_m, 0.0) << block;
}

TEST(HarshSizes, OfMountClockImuAndFeetAreThoseOfThePreset) {
  const std::string block = documented("faults", "robot.md");
  const sim::Faults told = faults(scenario_with(block).faults),
                    harsh = faults(scenario_with("faults: {preset: harsh}\n").faults);
  EXPECT_EQ(told.clock.offset_s, harsh.clock.offset_s) << block;
  EXPECT_EQ(told.clock.jitter_s, harsh.clock.jitter_s) << block;
  EXPECT_EQ(told.mount.length_m, harsh.mount.length_m) << block;
  EXPECT_DOUBLE_EQ(told.mount.angle_rad, harsh.mount.angle_rad) << block;
  EXPECT_EQ(told.imu.gyro_bias, harsh.imu.gyro_bias) << block;
  EXPECT_EQ(told.imu.accelerometer_bias, harsh.imu.accelerometer_bias) << block;
  EXPECT_EQ(told.imu.scale, harsh.imu.scale) << block;
  EXPECT_EQ(told.slip.speed_mps, harsh.slip.speed_mps) << block;
  EXPECT_EQ(told.slip.duration_s, harsh.slip.duration_s) << block;
  EXPECT_EQ(told.slip.every_s, harsh.slip.every_s) << block;
  EXPECT_GT(told.clock.offset_s, 0.0) << block;
}

}  // namespace
}  // namespace plumbline
