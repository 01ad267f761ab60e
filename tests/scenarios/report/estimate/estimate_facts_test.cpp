// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/estimate/estimate_facts.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace plumbline::scenarios {
namespace {

std::string value_of(const EstimateFacts& facts, const std::string& heading) {
  for (const auto& [key, value] : facts.given)
    if (key == heading) return value;
  return "(none)";
}

TEST(EstimateFacts, AreReadInWords) {
  const EstimateFacts facts = estimate_facts(read_yaml(
      "estimate: 1\nmethod: amcl\nseed: 3\nsensors: lidar\nevery: 2\nwithout: [rings, times]\n"
      "unchecked: [lidar.pcap]\nleft_out: [one scan]\nassumed: [a unit]\nwarnings: [no mount]\n"
      "given: {recording: walk.bag, odometry: true, lidar_height_m: 0.7, lidar_height_from: scans, plan: house.ifc, "
      "plan_furniture: as_planned, yaw_deg: 90, command: plumbline estimate walk.bag}\n"
      "input: {points: /scan, odometry: /odom, frame: velodyne, mount: tf_static, scans: 9, rings: 16, point_times: "
      "true, origin_ns: 1234}\nplan_moved_by_m: [-500005, -5000004, 0]\nconfig: {a: 1}\n",
      "estimate.yaml"));
  EXPECT_EQ(facts.recording, "walk.bag");
  EXPECT_EQ(facts.command, "plumbline estimate walk.bag");
  EXPECT_EQ(facts.origin, 1234);
  EXPECT_EQ(facts.warnings, (std::vector<std::string>{"one scan", "a unit", "no mount"}));
  EXPECT_EQ(facts.unchecked, std::vector<std::string>{"lidar.pcap"});
  EXPECT_EQ(facts.config, "a: 1\n");
  EXPECT_EQ(value_of(facts, "of these"), "16 rings, points with times");
  EXPECT_EQ(value_of(facts, "kept back"), "one scan in 2; without rings, times");
  EXPECT_EQ(value_of(facts, "mount of the LiDAR"), "from /tf_static");
  EXPECT_EQ(value_of(facts, "its height"), "0.7 m above the floor (by the first scans that show it)");
  EXPECT_EQ(value_of(facts, "odometry"), "read /odom");
  EXPECT_EQ(value_of(facts, "it got"), "LiDAR alone");
  EXPECT_EQ(value_of(facts, "furniture in the plan"), "as planned");
  EXPECT_EQ(value_of(facts, "heading at the start"), "90°");
  EXPECT_EQ(value_of(facts, "storey at the start"), "unknown");
  EXPECT_EQ(value_of(facts, "plan moved by, m"), "-500005, -5000004, 0");
}

TEST(EstimateFacts, OfAnEarlierVersionAreFewer) {
  const EstimateFacts facts =
      estimate_facts(read_yaml("estimate: 1\nmethod: vgicp\nseed: 1\ninput: {mount: unknown, scans: 3}\n", "e.yaml"));
  EXPECT_TRUE(facts.command.empty() && facts.recording.empty() && facts.warnings.empty());
  EXPECT_EQ(value_of(facts, "heading at the start"), "(none)");  // it has no plan
  EXPECT_EQ(value_of(facts, "odometry"), "(none)");
  EXPECT_EQ(value_of(facts, "mount of the LiDAR"), "not known: the robot's frame is the LiDAR's");
}

}  // namespace
}  // namespace plumbline::scenarios
