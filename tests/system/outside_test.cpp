// SPDX-License-Identifier: Apache-2.0
// Trajectories of other programs: on other clocks, in other orders, out of bags.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "bim/config/tree.h"
#include "slam/io/recordings/tum.h"
#include "tests/system/program.h"
#include "tests/system/run_once.h"

namespace plumbline::system_tests {
namespace {

namespace fs = std::filesystem;

class OutsideTrajectory : public RunOnce<OutsideTrajectory> {
 public:
  static Outcome begin() {
    return plumbline({"run", project_file("tests/system/short.yaml"), "--method", "vgicp", "--out", *folder_ / "run"});
  }

 protected:
  static std::string run() { return *folder_ / "run"; }
  static std::vector<slam::StampedPose> poses() { return slam::read_tum(read_file(run() + "/vgicp.tum"), "vgicp"); }
  static Outcome score(const std::string& estimate) { return plumbline({"score", run(), "--estimate", estimate}); }
  static void refuse(const std::string& estimate, const std::string& words) {
    const Outcome outcome = score(estimate);
    EXPECT_EQ(outcome.code, 2) << estimate << "\n" << outcome.out << outcome.err;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
  }
  static nlohmann::json methods() { return nlohmann::json::parse(read_file(run() + "/results.json"))["methods"]; }
};

TEST_F(OutsideTrajectory, QuaternionsInTheOtherOrderAreNoticed) {
  std::string w_first, w_last, right;
  for (const slam::StampedPose& pose : poses()) {
    const auto words = [&](const std::string& stamp, const char* between, const std::vector<double>& q) {
      std::string line = stamp;
      for (const double v : {pose.X_FR.t.x(), pose.X_FR.t.y(), pose.X_FR.t.z(), q[0], q[1], q[2], q[3]})
        line += between + format_number(v);
      return line + "\n";
    };
    const Eigen::Quaterniond& q = pose.X_FR.q;
    w_first += words(slam::format_stamp(pose.stamp), " ", {q.w(), q.x(), q.y(), q.z()});
    w_last += words(std::to_string(pose.stamp), ",", {q.x(), q.y(), q.z(), q.w()});
    right += words(std::to_string(pose.stamp), ",", {q.w(), q.x(), q.y(), q.z()});
  }
  write_file(*folder_ / "w_first.tum", w_first);
  write_file(*folder_ / "w_last.csv", w_last);
  write_file(*folder_ / "right.csv", right);
  refuse("e=" + *folder_ / "w_first.tum",
         "its quaternions seem to be in the order w x y z: read so, the error over each metre is 0.0");
  refuse("e=" + *folder_ / "w_last.csv",
         "its quaternions seem to be in the order x y z w: read so, the error over each metre is 0.0");
  EXPECT_EQ(score("e=" + *folder_ / "right.csv").code, 0);

  // A reference, too.
  const std::string walk = *folder_ / "walk", estimate = *folder_ / "estimate";
  ASSERT_EQ(plumbline({"simulate", project_file("tests/system/short.yaml"), "-o", walk}).code, 0);
  ASSERT_EQ(plumbline({"estimate", walk, "--method", "odometry", "-o", estimate}).code, 0);
  const Outcome outcome = plumbline({"score", estimate, "--reference", *folder_ / "w_first.tum"});
  EXPECT_EQ(outcome.code, 2) << outcome.out;
  EXPECT_NE(outcome.err.find("w_first.tum: its quaternions seem to be in the order w x y z"), std::string::npos)
      << outcome.err;
  EXPECT_EQ(plumbline({"score", estimate, "--reference", run() + "/vgicp.tum"}).code, 0);
}

TEST_F(OutsideTrajectory, OnAnotherClockTheShiftIsFoundByItsMotion) {
  const auto shifted = [](slam::Nanoseconds by, std::size_t from) {
    std::vector<slam::StampedPose> all = poses();
    all.erase(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(from));
    for (slam::StampedPose& pose : all) pose.stamp += by;
    return slam::write_tum(all);
  };
  const std::string file = *folder_ / "other_clock.tum";
  for (const slam::Nanoseconds by : {1'700'000'000'123'456'789LL, -370'000'000LL, 250'000'000LL}) {
    write_file(file, shifted(by, 0));
    const Outcome found = score("e=" + file + ",shift=auto");
    ASSERT_EQ(found.code, 0) << found.err;
    EXPECT_NE(found.out.find("e: " + slam::format_stamp(-by) + " s added to its stamps"), std::string::npos)
        << found.out;
    EXPECT_EQ(methods()["e"]["ate_aligned_rmse_m"], methods()["vgicp"]["ate_aligned_rmse_m"]);
    EXPECT_EQ(methods()["e"]["shift_ns"], -by);
    ASSERT_EQ(plumbline({"score", run()}).code, 0);  // the file keeps it
    EXPECT_EQ(methods()["e"]["shift_ns"], -by);
  }
  EXPECT_FALSE(methods()["vgicp"].contains("shift_ns"));
  write_file(file, shifted(1'700'000'000'000'000'000, 30));  // it began later
  EXPECT_NE(score("e=" + file + ",shift=auto").out.find("e: -1700000000.000000000 s added"), std::string::npos);
  refuse("e=" + file, "shift=auto finds what is between two clocks");
  write_file(file, shifted(2'000'000'000, 0));
  EXPECT_EQ(score("e=" + file + ",frame=M,shift=-2").code, 0);
  EXPECT_EQ(methods()["e"]["ate_aligned_rmse_m"], methods()["vgicp"]["ate_aligned_rmse_m"]);
  refuse("e=" + file + ",shift=soon", "'shift=soon' must be auto, or seconds");
  refuse("e=" + file + ",shift=1,shift=2", "has shift twice");
  write_file(file, "3e9 0 0 0 0 0 0 1\n");
  refuse("e=" + file + ",shift=3e9", "makes stamps of 3000000000.000000000 s too large");

  std::vector<slam::StampedPose> still = poses();
  for (slam::StampedPose& pose : still) pose.X_FR = Pose();
  write_file(file, slam::write_tum(still));
  refuse("e=" + file + ",shift=auto", "no single time at which its motion is that of the run");
}

TEST_F(OutsideTrajectory, PosesAreReadFromATopicOfABag) {
  const std::string walk = *folder_ / "bags";
  ASSERT_EQ(
      plumbline({"simulate", project_file("tests/system/short.yaml"), "-o", walk, "--bag", "--mcap", "--rosbag2"}).code,
      0);
  ASSERT_EQ(score("e=" + walk + "/odometry.tum").code, 0);
  const double ate = methods()["e"]["ate_aligned_rmse_m"];
  for (const char* name : {"recording.bag", "recording.mcap", "rosbag2"}) {
    const Outcome outcome = score("e=" + walk + "/" + name + ",topic=/odom");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NEAR(methods()["e"]["ate_aligned_rmse_m"], ate, 1e-4) << name;
    refuse("e=" + walk + "/" + name, "is a bag; name the topic of its poses: e=" + walk + "/" + name + ",topic=");
    refuse("e=" + walk + "/" + name + ",topic=/odm",
           "without messages on /odm; poses are on /odom (nav_msgs/Odometry)");
    refuse("e=" + walk + "/" + name + ",topic=/imu/data", "/imu/data is of type sensor_msgs/Imu, which is no pose");
  }
  refuse("e=" + run() + "/vgicp.tum,topic=/odom", "is no bag, and 'topic' is of one");
  refuse("e=" + run() + ",shift=1", "not of a directory of estimate");
}

}  // namespace
}  // namespace plumbline::system_tests
