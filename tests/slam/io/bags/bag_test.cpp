// SPDX-License-Identifier: Apache-2.0
#include "slam/io/bags/bag.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

#include "bim/errors.h"
#include "tests/folder.h"
#include "tests/input_error.h"
#include "tests/slam/io/packets/packets.h"

namespace plumbline::slam {
namespace {

namespace fs = std::filesystem;

class BagTest : public ::testing::Test {
 protected:
  [[nodiscard]] std::string file(const std::string& name) const { return folder_ / name; }

  static std::string bytes(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  static std::string complaint(const std::string& path, const BagTopics& topics = {}) {
    return input_error([&] {
      const auto recording = open_bag(path, topics, nullptr);
      for (SensorFrame frame; recording->next(frame);) {
      }
    });
  }

 private:
  Folder folder_;
};

Calibration mount() {
  Calibration calibration;
  calibration.X_RL = exp_se3((Vector6d() << 0.1, -0.2, 0.3, 0.01, 0.02, 1.0).finished());
  return calibration;
}

Odometry odometry_at(Nanoseconds stamp) {
  const double s = seconds(stamp);
  return {stamp, exp_se3((Vector6d() << 0.3 * s, -0.1 * s, 0.0, 1e-3 * s, 0.0, 0.2 * s).finished())};
}

/// Three messages with odometry at 100 Hz and IMU at 250 Hz, from 0 or from a time of day on.
std::vector<SensorFrame> three_frames(Nanoseconds start = 0) {
  const std::vector<Vlp16Packet> packets = turning_packets(3 * 76, start);
  std::vector<SensorFrame> frames(3);
  Nanoseconds odometry = start, imu = start;
  for (std::size_t m = 0; m < 3; ++m) {
    frames[m].scan = decode_message(std::span(packets).subspan(76 * m, 76));
    for (; odometry <= frames[m].scan.stamp; odometry += 10'000'000) {
      frames[m].odometry.push_back(odometry_at(odometry - start));
      frames[m].odometry.back().stamp = odometry;
    }
    for (; imu <= frames[m].scan.stamp; imu += 4'000'000)
      frames[m].imu.push_back({imu, Eigen::Vector3d(0.1, 0.2, 1.0 / 3.0), Eigen::Vector3d(0, -0.5, 9.81)});
  }
  return frames;
}

void write(const std::string& path, const BagProfile& profile, const std::vector<SensorFrame>& frames) {
  BagWriter writer(path, profile, mount());
  for (const SensorFrame& frame : frames) writer.add(frame.scan, frame.odometry, frame.imu, frame.covariances);
  writer.finish();
}

TEST_F(BagTest, EveryProfileIsReadBack) {
  const std::vector<SensorFrame> frames = three_frames();
  for (const BagProfile& profile : bag_profiles) {
    const std::string path = file(std::string(profile.name) + ".bag");
    write(path, profile, frames);
    EXPECT_TRUE(is_bag(path));
    const auto recording = open_bag(path, {}, nullptr);
    EXPECT_TRUE(recording->has_odometry());
    const Pose X_RL = calibration_of(recording->info()).X_RL;
    EXPECT_LT((X_RL.t - mount().X_RL.t).norm(), 1e-12);
    EXPECT_LT(X_RL.q.angularDistance(mount().X_RL.q), 1e-7);
    for (const SensorFrame& expected : frames) {
      SensorFrame frame;
      ASSERT_TRUE(recording->next(frame)) << profile.name;
      ASSERT_EQ(frame.odometry.size(), expected.odometry.size());
      for (std::size_t i = 0; i < frame.odometry.size(); ++i) {
        EXPECT_EQ(frame.odometry[i].stamp, expected.odometry[i].stamp);
        EXPECT_EQ(frame.odometry[i].X_OR.t, expected.odometry[i].X_OR.t);
      }
      ASSERT_EQ(frame.imu.size(), expected.imu.size());
      EXPECT_EQ(frame.imu.back().angular_velocity_R, expected.imu.back().angular_velocity_R);
      // A dense cloud ends with its last return, the others' times are floats.
      EXPECT_NEAR(static_cast<double>(frame.scan.stamp), static_cast<double>(expected.scan.stamp), 60'000.0);
      ASSERT_EQ(frame.scan.columns, expected.scan.columns);
      for (std::size_t i = 0; i < frame.scan.size(); ++i)
        ASSERT_LT((frame.scan.point_L[i] - expected.scan.point_L[i]).norm(), 3e-6);
    }
    SensorFrame end;
    EXPECT_FALSE(recording->next(end));
  }
}

TEST_F(BagTest, HoldsTheCovariancesOfTheOdometry) {
  std::vector<SensorFrame> frames = three_frames();
  const Matrix6d covariance = (Vector6d() << 1e-8, 2e-8, 3e-8, 4e-9, 5e-9, 6e-9).finished().asDiagonal();
  for (SensorFrame& frame : frames)
    for (const Odometry& record : frame.odometry)
      if (record.stamp > 0) frame.covariances.push_back({record.stamp, covariance});
  write(file("c.bag"), bag_profiles[0], frames);
  const auto recording = open_bag(file("c.bag"), {}, nullptr);
  for (const SensorFrame& expected : frames) {
    SensorFrame frame;
    ASSERT_TRUE(recording->next(frame));
    ASSERT_EQ(frame.covariances.size(), expected.covariances.size());
    for (std::size_t i = 0; i < frame.covariances.size(); ++i) {
      EXPECT_EQ(frame.covariances[i].stamp, expected.covariances[i].stamp);
      EXPECT_LE((frame.covariances[i].covariance - covariance).norm(), 1e-12 * covariance.norm());
    }
  }
}

TEST_F(BagTest, TimesOfTheDayStartAtZeroAndOdometryAtTheRobot) {
  const Nanoseconds start = 1'600'000'000'123'456'789;
  std::vector<SensorFrame> frames = three_frames(start);
  const Pose X_BO = Pose::from_xyz_yaw({10, 20, 3}, 2.0);
  for (SensorFrame& frame : frames)
    for (Odometry& record : frame.odometry) record.X_OR = X_BO * record.X_OR;
  write(file("day.bag"), bag_profiles[0], frames);
  const auto recording = open_bag(file("day.bag"), {}, nullptr);
  SensorFrame frame;
  ASSERT_TRUE(recording->next(frame));
  EXPECT_EQ(recording->origin(), start);
  EXPECT_EQ(frame.odometry[1].stamp, 10'000'000);
  EXPECT_LT((frame.odometry[1].X_OR.t - odometry_at(10'000'000).X_OR.t).norm(), 1e-12);
}

TEST_F(BagTest, AScanWithoutReturnsIsReadBack) {
  std::vector<SensorFrame> frames = three_frames();
  std::fill(frames[1].scan.range_m.begin(), frames[1].scan.range_m.end(), 0.0);
  write(file("blind.bag"), bag_profiles[2], frames);
  const auto recording = open_bag(file("blind.bag"), {}, nullptr);
  SensorFrame frame;
  Nanoseconds last = -1;
  for (const int columns : {1824, 0, 1824}) {
    ASSERT_TRUE(recording->next(frame));
    EXPECT_EQ(frame.scan.columns, columns);
    EXPECT_GT(frame.scan.stamp, last);
    last = frame.scan.stamp;
  }
  EXPECT_FALSE(recording->next(frame));
}

TEST_F(BagTest, ScansBeforeTheFirstOdometryAreLeftOut) {
  std::vector<SensorFrame> frames = three_frames();
  frames[0].odometry.clear();
  write(file("late.bag"), bag_profiles[0], frames);
  const auto recording = open_bag(file("late.bag"), {}, nullptr);
  SensorFrame frame;
  for (const std::size_t k : {1U, 2U}) {
    ASSERT_TRUE(recording->next(frame));
    EXPECT_NEAR(static_cast<double>(frame.scan.stamp), static_cast<double>(frames[k].scan.stamp), 16.0);
    EXPECT_EQ(frame.odometry.size(), frames[k].odometry.size());
  }
  EXPECT_FALSE(recording->next(frame));
}

// One record a scan, at its begin: by the first alone the robot would stand still during the first scan.
TEST_F(BagTest, AScanOfWhoseMotionNothingIsKnownIsLeftOut) {
  std::vector<SensorFrame> frames = three_frames();
  const auto keep = [&](std::size_t k, std::size_t record) {
    frames[k].odometry = {frames[k].odometry.at(record)};
    frames[k].covariances.clear();
  };
  keep(0, 0);
  keep(1, frames[1].odometry.size() / 2);
  write(file("slow.bag"), bag_profiles[0], frames);
  const auto recording = open_bag(file("slow.bag"), {}, nullptr);
  SensorFrame frame;
  ASSERT_TRUE(recording->next(frame));
  EXPECT_NEAR(static_cast<double>(frame.scan.stamp), static_cast<double>(frames[1].scan.stamp), 16.0);
  EXPECT_EQ(frame.odometry.size(), 2U);
  ASSERT_EQ(recording->left_out().size(), 1U);
  EXPECT_NE(recording->left_out().front().find("1 of 2 scans left out"), std::string::npos)
      << recording->left_out().front();
}

TEST_F(BagTest, OdometryThatNoScanMeetsIsRefused) {
  const std::vector<std::pair<Nanoseconds, std::string>> shifts = {
      {1'000'000'000'000, "/odom: no odometry at or before any scan"},
      {-1'000'000'000'000, "/odom: the odometry ends before the first scan"}};
  for (const auto& [shift, what] : shifts) {
    std::vector<SensorFrame> frames = three_frames(2'000'000'000'000);
    for (SensorFrame& frame : frames)
      for (Odometry& record : frame.odometry) record.stamp += shift;
    write(file("apart.bag"), bag_profiles[0], frames);
    const std::string text = complaint(file("apart.bag"));
    EXPECT_EQ(text.rfind(file("apart.bag"), 0), 0U) << text;
    EXPECT_NE(text.find(what), std::string::npos) << text;
  }
}

TEST_F(BagTest, TheSameRecordsGiveTheSameBytes) {
  write(file("a.bag"), bag_profiles[0], three_frames());
  write(file("b.bag"), bag_profiles[0], three_frames());
  EXPECT_GT(bytes(file("a.bag")).size(), 1'000'000U);
  EXPECT_TRUE(bytes(file("a.bag")) == bytes(file("b.bag")));
  EXPECT_FALSE(fs::exists(file("a.bag.part")));
}

TEST_F(BagTest, TruthIsNeverTakenForOdometry) {
  {
    const std::vector<SensorFrame> frames = three_frames();
    BagWriter writer(file("truth.bag"), bag_profiles[0], mount());
    const std::vector<StampedPose> truth = {{5'000'000, Pose{}}};
    writer.add_truth(truth);
    writer.add(frames[0].scan, {}, {});
    writer.finish();
  }
  EXPECT_FALSE(open_bag(file("truth.bag"), {}, nullptr)->has_odometry());
}

TEST_F(BagTest, NamesWhatIsWrong) {
  std::vector<SensorFrame> frames = three_frames();
  const std::string path = file("bad.bag");
  write(path, bag_profiles[0], frames);
  EXPECT_EQ(complaint(path), "no error");
  EXPECT_NE(complaint(path, {"/none", "", ""}).find("without messages on /none"), std::string::npos);
  EXPECT_NE(complaint(path, {"/odom", "", ""}).find("is of type nav_msgs/Odometry"), std::string::npos);
  const auto size = fs::file_size(path);
  for (const double share : {0.0005, 0.01, 0.5, 0.99, 0.99999}) {
    fs::copy_file(path, file("cut.bag"), fs::copy_options::overwrite_existing);
    fs::resize_file(file("cut.bag"), static_cast<std::uintmax_t>(share * static_cast<double>(size)));
    const std::string text = complaint(file("cut.bag"));
    if (share < 0.9)
      EXPECT_EQ(text.rfind(file("cut.bag"), 0), 0U) << share << ": " << text;
    else
      EXPECT_EQ(text, "no error") << share << ": the index alone is cut";
  }
  for (SensorFrame& frame : frames)
    for (Odometry& record : frame.odometry) record.X_OR.t.x() = std::numeric_limits<double>::quiet_NaN();
  write(path, bag_profiles[0], frames);
  EXPECT_NE(complaint(path).find("records hold numbers that are no pose"), std::string::npos) << complaint(path);
}

TEST_F(BagTest, UnwritablePlaceIsAnEnvironmentError) {
  EXPECT_THROW(BagWriter(file("no/such/folder.bag"), bag_profiles[0], mount()), EnvironmentError);
}

TEST_F(BagTest, OpensInRosbagOfPython) {
  if (std::system("/usr/bin/python3 -c 'import rosbag, sensor_msgs.point_cloud2' >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "python3-rosbag and python3-sensor-msgs are not installed";
  write(file("p.bag"), bag_profiles[0], three_frames());
  std::ofstream(file("read.py")) << R"(import sys, math, rosbag
from sensor_msgs import point_cloud2
bag = rosbag.Bag(sys.argv[1])
topics = bag.get_type_and_topic_info()[1]
assert topics['/velodyne_points'].msg_type == 'sensor_msgs/PointCloud2' and topics['/velodyne_points'].message_count == 3
assert topics['/odom'].message_count == 31 == topics['/tf'].message_count == topics['/clock'].message_count, topics
assert topics['/imu/data'].message_count == 76 and topics['/tf_static'].message_count == 1
assert bag.get_compression_info().compression == 'lz4'
last = 0
for _, cloud, time in bag.read_messages('/velodyne_points'):
    assert cloud.header.frame_id == 'velodyne' and (cloud.height, cloud.width) == (1824, 16)
    assert [f.name for f in cloud.fields] == ['x', 'y', 'z', 'intensity', 'ring', 'time']
    points = list(point_cloud2.read_points(cloud))
    assert len(points) == 1824 * 16 and len(list(point_cloud2.read_points(cloud, skip_nans=True))) < len(points)
    assert points[0][5] == 0 and 0.1 < points[-1][5] < 0.101 and points[17][4] == 1
    assert time.to_nsec() > last
    last = time.to_nsec()
for _, odometry, time in bag.read_messages('/odom'):
    assert odometry.header.frame_id == 'odom' and odometry.child_frame_id == 'base_link'
)";
  EXPECT_EQ(std::system(("/usr/bin/python3 " + file("read.py") + " " + file("p.bag")).c_str()), 0);
}

}  // namespace
}  // namespace plumbline::slam
