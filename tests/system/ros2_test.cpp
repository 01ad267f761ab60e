// SPDX-License-Identifier: Apache-2.0
// One walk in every kind of bag.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tests/bag_database.h"
#include "tests/system/program.h"

namespace plumbline::system_tests {
namespace {

namespace fs = std::filesystem;

class Ros2 : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY and PLUMBLINE_SOURCE are not set; run through ctest";
  }
  /// Five seconds through two rooms.
  [[nodiscard]] std::string simulated(const std::vector<std::string>& bags) const {
    fs::copy_file(project_file("tests/system/short.plan.yaml"), folder_ / "short.plan.yaml");
    write_file(folder_ / "walk.yaml",
               "scenario: 1\nname: walk\nbuilding: short.plan.yaml\nseed: 3\nstart: {room: left}\n"
               "route: {rooms: [hall, right]}\nduration_s: 5\nmethods: [truth]\n");
    std::string walk = folder_ / "walk";
    std::vector<std::string> arguments = {"simulate", folder_ / "walk.yaml", "-o", walk};
    arguments.insert(arguments.end(), bags.begin(), bags.end());
    const Outcome made = plumbline(arguments);
    EXPECT_EQ(made.code, 0) << made.err;
    return walk;
  }
  Folder folder_;
};

TEST_F(Ros2, EveryKindOfBagGivesTheSameEstimate) {
  const std::string walk = simulated({"--bag", "--mcap", "--compression", "zstd", "--rosbag2", "--bag-truth"});
  const auto estimate = [&](const std::string& recording, const std::string& name) {
    const Outcome outcome =
        plumbline({"estimate", walk + "/" + recording, "--method", "s_graphs_plus", "-o", folder_ / name});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return read_file(folder_ / (name + "/s_graphs_plus.tum")) + read_file(folder_ / (name + "/digests.csv"));
  };
  const std::string expected = estimate("recording.bag", "of_bag");
  EXPECT_GT(expected.size(), 1000U);
  EXPECT_TRUE(estimate("recording.mcap", "of_mcap") == expected);
  EXPECT_TRUE(estimate("rosbag2", "of_rosbag2") == expected);
  EXPECT_TRUE(estimate("rosbag2/rosbag2_0.db3", "of_db3") == expected);
  const std::string out = folder_ / "of_mcap", bag = walk + "/recording.mcap";
  const Outcome by_bag = plumbline({"score", out, "--reference", bag + ",topic=/ground_truth/odom"});
  ASSERT_EQ(by_bag.code, 0) << by_bag.err;
  const std::string by_topic = read_file(out + "/score.json");
  ASSERT_EQ(plumbline({"score", out, "--reference", walk + "/truth.tum"}).code, 0);
  EXPECT_NEAR(nlohmann::json::parse(by_topic)["causal"]["ate_aligned_rmse_m"],
              nlohmann::json::parse(read_file(out + "/score.json"))["causal"]["ate_aligned_rmse_m"], 1e-6);
  const Outcome unnamed = plumbline({"score", out, "--reference", bag});
  EXPECT_EQ(unnamed.code, 2);
  EXPECT_NE(unnamed.err.find("is a bag; name the topic of its poses"), std::string::npos) << unnamed.err;
  // Of a recording without packets any bag is the recording.
  fs::remove(walk + "/lidar.pcap");
  fs::remove(walk + "/recording.bag");
  EXPECT_EQ(plumbline({"estimate", walk, "--method", "odometry", "-o", folder_ / "of_folder"}).code, 0);
}

TEST_F(Ros2, RecordsThatComeLateAreNamed) {
  const std::string walk = simulated({"--rosbag2"}), database = walk + "/rosbag2/rosbag2_0.db3";
  const auto estimate = [&](const std::string& name) {
    const Outcome outcome = plumbline({"estimate", database, "--method", "vgicp", "-o", folder_ / name});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return std::pair(outcome.err, read_file(folder_ / (name + "/estimate.yaml")));
  };
  EXPECT_EQ(estimate("whole").second.find("left_out"), std::string::npos);
  swap_messages(database, "/imu/data", 5);
  const auto [said, description] = estimate("late");
  const std::string words = "/imu/data: 1 record left out, as stamps go back by up to 4 ms";
  EXPECT_NE(said.find("plumbline: warning: " + database + ": " + words), std::string::npos) << said;
  EXPECT_NE(description.find("left_out:"), std::string::npos) << description;
  EXPECT_NE(description.find(words), std::string::npos) << description;
}

TEST_F(Ros2, WhatWasTakenIsSaid) {
  const std::string walk = simulated({"--rosbag2"}), database = walk + "/rosbag2/rosbag2_0.db3";
  const auto estimate = [&](const std::string& recording, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"estimate",           recording, "--method", "odometry", "-o",
                                          folder_ / "estimate", "--force"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return plumbline(arguments);
  };
  run_sql(database,
          "INSERT INTO topics SELECT 99, '/other/points', type, serialization_format, offered_qos_profiles "
          "FROM topics WHERE name = '/velodyne_points';");
  const Outcome bag = estimate(database, {});
  EXPECT_EQ(bag.code, 0) << bag.err;
  EXPECT_EQ(
      bag.out.rfind("/velodyne_points (not /other/points): 49 scans, 16 rings, points with times; frame velodyne; "
                    "mount from /tf_static; odometry /odom of base_link; IMU /imu/data\n",
                    0),
      0U)
      << bag.out;
  const std::string said = read_file(folder_ / "estimate/estimate.yaml");
  for (const std::string words : {"input:", "points: /velodyne_points", "other_points:", "frame: velodyne",
                                  "mount: tf_static", "scans: 49", "rings: 16", "point_times: true"})
    EXPECT_NE(said.find(words), std::string::npos) << words << ":\n" << said;

  run_sql(database, "DELETE FROM messages WHERE topic_id = (SELECT id FROM topics WHERE name = '/tf_static');");
  const Outcome unknown = estimate(database, {"--without", "times"});
  EXPECT_EQ(unknown.code, 0) << unknown.err;
  EXPECT_NE(unknown.err.find("where the LiDAR sits on the robot is not known"), std::string::npos) << unknown.err;
  EXPECT_NE(unknown.out.find("points without times"), std::string::npos) << unknown.out;

  const Outcome recording = estimate(walk, {});
  EXPECT_NE(recording.out.find("49 scans, 16 rings, points with times; mount from the description; odometry\n"),
            std::string::npos)
      << recording.out;
  const Outcome topic = estimate(walk, {"--points-topic", "/points"});
  EXPECT_EQ(topic.code, 2);
  EXPECT_NE(topic.err.find("--points-topic: is of bags"), std::string::npos) << topic.err;
}

TEST_F(Ros2, WhatIsNoneIsRefused) {
  const auto refused = [&](const std::string& name, const std::string& words) {
    const Outcome outcome = plumbline({"estimate", folder_ / name, "--method", "vgicp", "-o", folder_ / "out"});
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(folder_ / "out"));
  };
  write_file(folder_ / "odd.mcap", "nothing");
  refused("odd.mcap", "is no ROS 2 bag");
  write_file(folder_ / "odd.db3", "SQLite format 2");
  refused("odd.db3", "is no ROS 2 bag");
  write_file(folder_ / "walk.mcap.zstd", "x");
  refused("walk.mcap.zstd", "decompress it first");
  fs::create_directory(folder_ / "split");
  write_file(folder_ / "split/split_0.db3", "x");
  refused("split", "it has no table");
  write_file(folder_ / "split/other.db3", "x");
  refused("split", "holds bags that are not one, 'other.db3' and 'split_0.db3'");
  const Outcome unused = plumbline({"simulate", "quickstart", "-o", folder_ / "walk", "--bag-truth"});
  EXPECT_EQ(unused.code, 2);
  EXPECT_NE(unused.err.find("--bag, --mcap or --rosbag2"), std::string::npos) << unused.err;
}

TEST_F(Ros2, ScenariosOfTheLibraryAreFoundByName) {
  Setting elsewhere;
  elsewhere.cwd = folder_ / "";
  const Outcome list = plumbline({"scenarios"}, elsewhere);
  EXPECT_EQ(list.code, 0) << list.err;
  for (const std::string name : {"quickstart ", "s_graphs/t7 "})
    EXPECT_NE(("\n" + list.out).find("\n" + name), std::string::npos) << list.out;
  const auto says = [&](const std::string& input, const std::string& words) {
    const Outcome outcome = plumbline({"run", input, "--method", "no_such", "-o", "out"}, elsewhere);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
  };
  for (const std::string input : {"quickstart", "t7", "s_graphs/t7"}) says(input, "no_such");
  says("quickstrat", "did you mean 'quickstart'?");
  fs::create_directory(folder_ / "quickstart");
  says("quickstart", "no_such");
  fs::create_directory(folder_ / "quickstrat");
  says("quickstrat", "is a directory");
  const Outcome doctor = plumbline({"doctor"}, elsewhere);
  EXPECT_EQ(doctor.code, 0) << doctor.out;
  for (const std::string words : {"scenarios", "clients", "all that the program itself needs is there"})
    EXPECT_NE(doctor.out.find(words), std::string::npos) << doctor.out;
}

}  // namespace
}  // namespace plumbline::system_tests
