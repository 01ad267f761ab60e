// SPDX-License-Identifier: Apache-2.0
// Bags whose messages are not as their fields' names say.
#include "tests/slam/io/bags/altered_walk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/folder.h"
#include "tests/input_error.h"

namespace plumbline::slam {
namespace {

struct Read {
  std::vector<SensorFrame> frames;
  std::vector<std::string> left_out, assumed;
  Taken taken;
  Pose mount;
};

class AlteredWalk : public ::testing::Test {
 protected:
  Read read(const Alteration& alteration, const BagTopics& topics = {}) {
    const std::string path = folder_ / ("walk" + std::to_string(written_++));
    write_altered(path, alteration);
    const auto recording = open_bag(path, topics, nullptr);
    Read out;
    for (SensorFrame frame; recording->next(frame);) out.frames.push_back(frame);
    out.left_out = recording->left_out();
    out.assumed = recording->assumed();
    out.taken = recording->taken();
    out.mount = calibration_of(recording->info()).X_RL;
    return out;
  }
  static Nanoseconds length(const Scan& scan) {
    return -*std::min_element(scan.offset_ns.begin(), scan.offset_ns.end());
  }

  Folder folder_;

 private:
  int written_ = 0;
};

TEST_F(AlteredWalk, TimesFromZeroToOneAreSharesOfASweep) {
  const Read plain = read({});
  EXPECT_TRUE(plain.assumed.empty() && plain.left_out.empty());
  ASSERT_EQ(plain.frames.size(), 4U);
  Alteration shares;
  const auto sweep = static_cast<float>(1e-9 * static_cast<double>(length(plain.frames[0].scan)));
  shares.cloud = [&](int, PointCloud& cloud) {
    change_field<float>(cloud, time_offset, [&](float t) { return t / sweep; });
  };
  const Read read_shares = read(shares);
  ASSERT_EQ(read_shares.assumed.size(), 1U);
  EXPECT_EQ(
      read_shares.assumed[0],
      "/velodyne_points: point times from 0 to 1 are taken as shares of a scan of 101 ms; clouds are 101 ms apart");
  ASSERT_EQ(read_shares.frames.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(static_cast<double>(read_shares.frames[i].scan.stamp - plain.frames[i].scan.stamp), 0.0, 1e5);
}

// A float holds no time of the day: steps of two minutes.
TEST_F(AlteredWalk, TimesThatCannotBeReadAreLeftOutWhereThatIsAsked) {
  Alteration of_day;
  of_day.cloud = [](int, PointCloud& cloud) {
    change_field<float>(cloud, time_offset, [](float t) { return 1.7e9F + t; });
  };
  EXPECT_NE(input_error([&] { (void)read(of_day); }).find("--without times leaves those of a bag out"),
            std::string::npos);
  BagTopics topics;
  topics.point_times = false;
  const Read plain = read({}), left_out = read(of_day, topics), readable = read({}, topics);
  ASSERT_EQ(left_out.assumed.size(), 1U);
  EXPECT_EQ(left_out.assumed[0], "/velodyne_points: point times cannot be read and are left out");
  ASSERT_EQ(left_out.frames.size(), 4U);
  for (const SensorFrame& frame : left_out.frames) EXPECT_EQ(length(frame.scan), 0);
  EXPECT_TRUE(readable.assumed.empty());
  ASSERT_EQ(readable.frames.size(), 4U);
  EXPECT_EQ(readable.frames[0].scan.offset_ns, plain.frames[0].scan.offset_ns);
}

TEST_F(AlteredWalk, RingsOfOneNumberAreLeftOutAndSaid) {
  Alteration constant;
  constant.cloud = [](int, PointCloud& cloud) {
    change_field<std::uint16_t>(cloud, ring_offset, [](std::uint16_t) { return std::uint16_t{0}; });
  };
  const Read plain = read({}), altered = read(constant);
  ASSERT_EQ(altered.left_out.size(), 1U);
  EXPECT_EQ(
      altered.left_out[0],
      "/velodyne_points: 4 of 4 scans read without their ring numbers, which are one for all points or not within "
      "0 to 127");
  ASSERT_EQ(altered.frames.size(), plain.frames.size());
  for (std::size_t i = 0; i < plain.frames.size(); ++i)
    EXPECT_EQ(altered.frames[i].scan.point_L, plain.frames[i].scan.point_L);
}

TEST_F(AlteredWalk, WhatIsStampedBeforeTheClockWasSetIsLeftOut) {
  constexpr Nanoseconds today = 1'700'000'000'000'000'000;
  Alteration late;
  late.cloud = [](int i, PointCloud& cloud) { cloud.stamp += i > 0 ? today : 0; };
  late.odometry = [](int, ros::OdometryMessage& message) { message.X_OR.stamp += today; };
  late.imu = [](int i, ros::FramedImu& message) { message.imu.stamp += i > 2 ? today : 0; };
  const Read read_late = read(late);
  EXPECT_EQ(read_late.frames.size(), 3U);
  ASSERT_EQ(read_late.left_out.size(), 2U);
  EXPECT_EQ(read_late.left_out[1],
            "/velodyne_points: 1 of 4 records left out: stamped before 2000, when the clock was not set");
  EXPECT_EQ(read_late.left_out[0].rfind("/imu/data: 3 of ", 0), 0U) << read_late.left_out[0];
  Alteration plain = late;
  plain.cloud = [](int, PointCloud& cloud) { cloud.stamp += today; };
  plain.imu = [](int, ros::FramedImu& message) { message.imu.stamp += today; };
  EXPECT_TRUE(read(plain).left_out.empty());
}

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

template <class Records>
std::size_t count(const std::vector<SensorFrame>& frames, Records records) {
  std::size_t sum = 0;
  for (const SensorFrame& frame : frames) sum += (frame.*records).size();
  return sum;
}

TEST_F(AlteredWalk, RecordsThatAreNoPoseAreLeftOut) {
  Alteration spoilt;
  spoilt.odometry = [](int i, ros::OdometryMessage& message) {
    if (i < 2) message.X_OR.X.q.coeffs().setZero();
    if (i == 20) message.X_OR.X.t.y() = nan;
  };
  spoilt.imu = [](int i, ros::FramedImu& message) {
    if (i == 30) message.imu.angular_velocity_R.x() = nan;
  };
  const Read plain = read({}), altered = read(spoilt);
  const std::size_t all = count(plain.frames, &SensorFrame::odometry);
  EXPECT_EQ(count(altered.frames, &SensorFrame::odometry), all - 3);
  EXPECT_EQ(count(altered.frames, &SensorFrame::imu), count(plain.frames, &SensorFrame::imu) - 1);
  ASSERT_EQ(altered.left_out.size(), 2U);
  EXPECT_EQ(altered.left_out[0],
            "/odom: 3 of " + std::to_string(all) + " records left out: numbers that are not finite, or no rotation");
  EXPECT_EQ(altered.left_out[1].rfind("/imu/data: 1 of ", 0), 0U) << altered.left_out[1];
  spoilt.odometry = [](int i, ros::OdometryMessage& message) {
    if (i % 3 > 0) message.X_OR.X.t.x() = nan;
  };
  EXPECT_NE(input_error([&] { (void)read(spoilt); }).find("records hold numbers that are no pose"), std::string::npos);
}

TEST_F(AlteredWalk, RingsOfMissingReturnsAreNotBelieved) {
  Alteration filled;
  filled.cloud = [](int, PointCloud& cloud) {
    for (std::size_t at = 0; at < cloud.data.size(); at += cloud.point_step) {
      float x = 0.0F;
      std::memcpy(&x, &cloud.data[at], sizeof x);
      if (!std::isfinite(x)) cloud.data[at + ring_offset] = cloud.data[at + ring_offset + 1] = 0xff;
    }
  };
  const Read plain = read({}), altered = read(filled);
  ASSERT_EQ(altered.frames.size(), 4U);
  EXPECT_EQ(altered.frames[2].scan.point_L, plain.frames[2].scan.point_L);
  filled.cloud = [](int, PointCloud& cloud) {
    change_field<std::uint16_t>(cloud, ring_offset, [](std::uint16_t) { return std::uint16_t{200}; });
  };
  const Read beyond = read(filled);
  ASSERT_EQ(beyond.frames.size(), 4U);
  EXPECT_EQ(beyond.frames[2].scan.point_L, plain.frames[2].scan.point_L) << "found by elevation";
  ASSERT_EQ(beyond.left_out.size(), 1U);
  EXPECT_NE(beyond.left_out[0].find("not within 0 to 127"), std::string::npos) << beyond.left_out[0];
}

TEST_F(AlteredWalk, AWrongMessageIsNamedByItsNumberOnItsTopic) {
  Alteration cut;
  cut.cloud = [](int i, PointCloud& cloud) {
    if (i == 2) cloud.data.resize(cloud.data.size() / 2);
  };
  const std::string complaint = input_error([&] { (void)read(cut); });
  EXPECT_NE(complaint.find(": message 3 of topic '/velodyne_points': "), std::string::npos) << complaint;
}

TEST_F(AlteredWalk, AScanWithoutPointsIsOfTheEndOfItsTurn) {
  Alteration blind;
  blind.cloud = [](int i, PointCloud& cloud) {
    if (i != 2) return;
    cloud.data.clear();
    cloud.width = cloud.height = cloud.row_step = 0;
  };
  const Read plain = read({}), altered = read(blind);
  ASSERT_EQ(altered.frames.size(), 4U);
  EXPECT_EQ(altered.frames[2].scan.size(), 0U);
  EXPECT_NEAR(seconds(altered.frames[2].scan.stamp), seconds(plain.frames[2].scan.stamp), 1e-3);
}

TEST_F(AlteredWalk, AStampFarAheadIsLeftOut) {
  const Read plain = read({});
  const std::size_t all = count(plain.frames, &SensorFrame::odometry);
  for (const bool has_odometry : {true, false}) {
    Alteration ahead;
    ahead.has_odometry = has_odometry;
    ahead.cloud = [](int i, PointCloud& cloud) { cloud.stamp += i == 1 ? 60'000'000'000 : 0; };
    const Read altered = read(ahead);
    ASSERT_EQ(altered.frames.size(), 3U) << has_odometry;
    EXPECT_EQ(altered.frames[1].scan.stamp, plain.frames[2].scan.stamp);
    ASSERT_EQ(altered.left_out.size(), 1U);
    EXPECT_EQ(altered.left_out[0].rfind("/velodyne_points: 1 record left out, with stamps up to 59.9 s ahead", 0), 0U)
        << altered.left_out[0];
  }
  Alteration odometry;
  odometry.odometry = [](int i, ros::OdometryMessage& message) { message.X_OR.stamp += i == 15 ? 10'000'000'000 : 0; };
  const Read altered = read(odometry);
  EXPECT_EQ(altered.frames.size(), 4U);
  EXPECT_EQ(count(altered.frames, &SensorFrame::odometry), all - 1);
  EXPECT_EQ(altered.left_out.size(), 1U);
  EXPECT_LE(count(altered.frames, &SensorFrame::covariances), all - 1);
}

TEST_F(AlteredWalk, AnImuThatIsNotJoinedIsLeftOut) {
  Alteration loose;
  loose.imu = [](int, ros::FramedImu& message) { message.frame = "imu_link"; };
  const Read altered = read(loose);
  EXPECT_EQ(altered.frames.size(), 4U);
  EXPECT_EQ(count(altered.frames, &SensorFrame::imu), 0U);
  EXPECT_EQ(altered.taken.imu, "");
  ASSERT_EQ(altered.left_out.size(), 1U);
  EXPECT_EQ(altered.left_out[0].rfind(
                "/imu/data left out: in frame 'imu_link', which /tf_static does not join to 'base_link'", 0),
            0U)
      << altered.left_out[0];
  loose.imu = [](int, ros::FramedImu& message) { message.imu.linear_acceleration_R.setConstant(nan); };
  EXPECT_EQ(read(loose).frames.size(), 4U);
}

TEST_F(AlteredWalk, RecordsInAnotherFrameAreLeftOut) {
  Alteration two;
  two.cloud_frame = [](int i) { return i % 2 == 0 ? "velodyne" : "/rear"; };
  const Read clouds = read(two);
  EXPECT_EQ(clouds.frames.size(), 2U);
  ASSERT_EQ(clouds.left_out.size(), 1U);
  EXPECT_EQ(clouds.left_out[0],
            "/velodyne_points left out: 2 of 4 scans in frame 'rear', not in 'velodyne' as the first");
  two.cloud_frame = [](int i) { return i == 0 ? "velodyne" : "rear"; };
  const std::string complaint = input_error([&] { (void)read(two); });
  EXPECT_NE(complaint.find("3 of 4 scans in frame 'rear', not in 'velodyne' as the first; at most half"),
            std::string::npos)
      << complaint;
  two.cloud_frame = [](int i) { return i == 0 ? "/velodyne" : "velodyne"; };
  EXPECT_TRUE(read(two).left_out.empty());
  const std::size_t all = count(read({}).frames, &SensorFrame::odometry);
  Alteration odometry;
  odometry.odometry = [](int i, ros::OdometryMessage& message) { message.X_OR.child = i == 5 ? "cart" : "base_link"; };
  const Read other = read(odometry);
  EXPECT_EQ(count(other.frames, &SensorFrame::odometry), all - 1);
  ASSERT_EQ(other.left_out.size(), 1U);
  EXPECT_NE(other.left_out[0].find("/odom left out: 1 of "), std::string::npos) << other.left_out[0];
}

TEST_F(AlteredWalk, TransformsWithoutOdometryAreSaidToBeUnread) {
  Alteration walk;
  walk.has_odometry = false;
  EXPECT_TRUE(read(walk).left_out.empty());
  for (const char* topic : {"/tf", "/robot/tf"}) {
    walk.transforms = topic;
    const Read out = read(walk);
    ASSERT_EQ(out.left_out.size(), 1U) << topic;
    EXPECT_NE(out.left_out[0].find("no odometry: no nav_msgs/Odometry, and on " + std::string(topic) + " no moving"),
              std::string::npos)
        << out.left_out[0];
  }
}

TEST_F(AlteredWalk, CloudsInTheRobotsFrameNeedNoMount) {
  Alteration walk;
  walk.cloud_frame = [](int) { return "base_link"; };
  walk.mount = [](int) { return Pose::from_xyz_yaw({0.1, -0.2, 0.3}, 1.0); };
  const Read out = read(walk);
  EXPECT_EQ(out.taken.mount, MountSource::same_frame);
  EXPECT_EQ(out.mount.t, Eigen::Vector3d(0, 0, 0));
  // Frames without names tell nothing.
  walk.cloud_frame = [](int) { return ""; };
  walk.odometry = [](int, ros::OdometryMessage& message) { message.X_OR.child.clear(); };
  EXPECT_EQ(read(walk).taken.mount, MountSource::unknown);
}

TEST_F(AlteredWalk, AMountIsTakenFromWhereverItStandsStill) {
  const Pose X_RL = Pose::from_xyz_yaw({0.1, -0.2, 0.3}, 1.0);
  Alteration walk;
  walk.mount = [&](int) { return X_RL; };
  for (const auto& [topic, source] :
       {std::pair("/tf_static", MountSource::tf_static), std::pair("/robot/tf_static", MountSource::tf_static),
        std::pair("/tf", MountSource::tf)}) {
    walk.transforms = topic;
    const Read out = read(walk);
    EXPECT_EQ(out.taken.mount, source) << topic;
    EXPECT_LT((out.mount.t - X_RL.t).norm(), 1e-9) << topic;
  }
  // A joint that nobody has set.
  walk.transforms = "/tf_static";
  walk.mount = [&](int i) { return i == 1 ? Pose{Eigen::Quaterniond(0.0, 0.0, 0.0, 0.0), X_RL.t} : X_RL; };
  const Read unset = read(walk);
  EXPECT_LT((unset.mount.t - X_RL.t).norm(), 1e-9);
  ASSERT_EQ(unset.left_out.size(), 1U);
  EXPECT_NE(unset.left_out[0].find("/tf_static: 1 transforms left out"), std::string::npos) << unset.left_out[0];
  walk.transforms = "/tf";
  walk.mount = [&](int i) { return Pose::from_xyz_yaw({0.1, -0.2, 0.3}, 1.0 + 1e-3 * i); };
  EXPECT_EQ(read(walk).taken.mount, MountSource::unknown) << "a LiDAR that turns on the robot";
}

TEST_F(AlteredWalk, CloudsWithoutStampsAreOfTheTimesOfRecording) {
  Alteration walk;
  walk.cloud = [](int, PointCloud& cloud) { cloud.stamp = 0; };
  const Read plain = read({}), out = read(walk);
  ASSERT_EQ(out.frames.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(out.frames[i].scan.stamp, plain.frames[i].scan.stamp) << i << ": it was recorded when its sweep was over";
  }
  ASSERT_EQ(out.assumed.size(), 1U);
  EXPECT_EQ(out.assumed[0], "/velodyne_points: the stamps of clouds are 0; the times of recording are taken for them");
  // A simulation's first cloud may be at 0.
  walk.cloud = [](int i, PointCloud& cloud) { cloud.stamp = i == 0 ? 0 : cloud.stamp; };
  EXPECT_TRUE(read(walk).assumed.empty());
}

TEST_F(AlteredWalk, WithoutOdometryTheMountIsInBaseLink) {
  Alteration walk;
  walk.has_odometry = false;
  walk.mount = [](int) { return Pose::from_xyz_yaw({0.1, -0.2, 0.3}, 1.0); };
  const Read out = read(walk);
  EXPECT_EQ(out.taken.mount, MountSource::tf_static);
  EXPECT_LT((out.mount.t - Eigen::Vector3d(0.1, -0.2, 0.3)).norm(), 1e-9);
  EXPECT_EQ(out.taken.imu, "/imu/data");
  walk.cloud_frame = [](int) { return "elsewhere"; };
  EXPECT_EQ(read(walk).taken.mount, MountSource::unknown);
}

TEST_F(AlteredWalk, StampsOfTwoClocksAreSaid) {
  for (const int ahead_s : {37, -37}) {
    Alteration walk;
    walk.cloud = [&](int, PointCloud& cloud) { cloud.stamp += std::max(ahead_s, 0) * 1'000'000'000LL; };
    walk.odometry = [&](int, ros::OdometryMessage& message) {
      message.X_OR.stamp += std::max(-ahead_s, 0) * 1'000'000'000LL;
    };
    const std::string said = input_error([&] { read(walk); });
    const std::string apart = ahead_s > 0 ? "37.0 s ahead of those on /odom" : "37.0 s behind those on /odom";
    EXPECT_NE(said.find("both on one clock? the stamps on /velodyne_points are " + apart), std::string::npos) << said;
  }
}

TEST_F(AlteredWalk, TimesHaveTheNamesThatDriversGiveThem) {
  const Read plain = read({});
  for (const char* name : {"t", "timestamp", "time_stamp", "offset_time", "time_offset"}) {
    Alteration walk;
    walk.cloud = [&](int, PointCloud& cloud) {
      for (PointField& field : cloud.fields)
        if (field.name == "time") field.name = name;
    };
    const Read out = read(walk);
    ASSERT_EQ(out.frames.size(), 4U) << name;
    EXPECT_EQ(out.frames[1].scan.offset_ns, plain.frames[1].scan.offset_ns) << name;
  }
}

// A map that stands first in a bag holds no scans.
TEST_F(AlteredWalk, ATopicWithHardlyAnyCloudsIsNotTheFirst) {
  const std::string path = folder_ / "maps";
  const auto sink = make_rosbag2_sink(path, "maps");
  const SensorFrame frame = walk_of_four_scans().front();
  const auto write = [&](const std::string& topic, Nanoseconds time) {
    PointCloud cloud = cloud_of(frame.scan, CloudLayout::organised);
    cloud.stamp += time;
    sink->write(topic, MessageType::cloud, time, ros::write_cloud(cloud, "map", Encoding::cdr), false);
  };
  write("/map", 0);
  for (int i = 0; i < 12; ++i) write("/scans", i * 100'000'000);
  for (int i = 0; i < 12; ++i) write("/other_scans", i * 100'000'000);
  sink->finish();
  EXPECT_EQ(open_bag(path, {}, nullptr)->taken().points, "/scans");
  EXPECT_EQ(open_bag(path, {}, nullptr)->taken().other_points, (std::vector<std::string>{"/map", "/other_scans"}));
  EXPECT_EQ(open_bag(path, {.points = "/map"}, nullptr)->taken().points, "/map");
}

}  // namespace
}  // namespace plumbline::slam
