// SPDX-License-Identifier: Apache-2.0
#include "slam/io/recordings/recording.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "bim/errors.h"
#include "slam/io/packets/pcap.h"
#include "slam/io/recordings/recording_writer.h"
#include "tests/folder.h"
#include "tests/input_error.h"
#include "tests/slam/io/packets/packets.h"

namespace plumbline::slam {
namespace {

namespace fs = std::filesystem;

class RecordingTest : public ::testing::Test {
 protected:
  [[nodiscard]] std::string path() const { return folder_.path(); }
  [[nodiscard]] std::string path(const std::string& name) const { return folder_ / name; }
  void put(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }

  /// Everything the recording gives; or what it complains of.
  static std::string complaint(const std::string& path) {
    return input_error([&] {
      const auto recording = open_recording(path);
      for (SensorFrame frame; recording->next(frame);) {
      }
    });
  }
  void expect_complaint(const std::string& path, const std::string& where, const std::string& what) const {
    const std::string text = complaint(path);
    EXPECT_EQ(text.rfind(where, 0), 0U) << text;
    EXPECT_NE(text.find(what), std::string::npos) << text;
  }

 private:
  Folder folder_;
};

Odometry odometry_at(Nanoseconds stamp) {
  const double s = seconds(stamp);
  return {stamp, exp_se3((Vector6d() << 0.3 * s, -0.1 * s, -0.0, 1e-3 * s, 1e-17, 0.2 * s).finished())};
}

/// A covariance with a -0, tiny and huge numbers in it.
Matrix6d covariance_at(Nanoseconds stamp) {
  const double s = seconds(stamp);
  const Matrix6d root = Matrix6d::Identity() + 0.1 * s * Matrix6d::Ones();
  Matrix6d m = 1e-6 / 3.0 * root * root.transpose();
  m.triangularView<Eigen::StrictlyLower>() = m.transpose();
  m(0, 5) = m(5, 0) = -0.0;
  m(1, 4) = m(4, 1) = 1e-300;
  return m;
}

Imu imu_at(Nanoseconds stamp) {
  return {stamp, Eigen::Vector3d(-0.0, 1.0 / 3.0, 1e-300), Eigen::Vector3d(9.81, -2e-7, 0.1 + seconds(stamp))};
}

bool same_bits(const Eigen::Ref<const Eigen::VectorXd>& a, const Eigen::Ref<const Eigen::VectorXd>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
  });
}

/// A recording of three messages, odometry at 100 Hz and IMU at 250 Hz.
std::vector<SensorFrame> write_three(const std::string& dir, const RecordingInfo& info, bool covariances = false) {
  const std::vector<Vlp16Packet> packets = turning_packets(3 * 76);
  std::vector<SensorFrame> frames(3);
  RecordingWriter writer(dir, info);
  Nanoseconds odometry = 0, imu = 0;
  for (std::size_t m = 0; m < frames.size(); ++m) {
    frames[m].packets.assign(packets.begin() + static_cast<std::ptrdiff_t>(76 * m),
                             packets.begin() + static_cast<std::ptrdiff_t>(76 * (m + 1)));
    frames[m].scan = decode_message(frames[m].packets);
    for (; odometry <= frames[m].scan.stamp; odometry += 10'000'000) {
      frames[m].odometry.push_back(odometry_at(odometry));
      if (covariances && odometry > 0) frames[m].covariances.push_back({odometry, covariance_at(odometry)});
    }
    for (; imu <= frames[m].scan.stamp; imu += 4'000'000) frames[m].imu.push_back(imu_at(imu));
    writer.add(frames[m].packets, frames[m].odometry, frames[m].imu);
    writer.add(frames[m].covariances);
  }
  writer.finish();
  return frames;
}

TEST_F(RecordingTest, GivesBackEveryBitThatWasWritten) {
  Calibration mount;
  mount.X_RL = exp_se3((Vector6d() << 0.1, -0.2, 0.3, 0.01, 0.02, 1.0).finished());
  Prior prior;
  prior.yaw_W = 1.0 / 3.0;
  prior.storey = "ground";
  const std::vector<SensorFrame> written = write_three(path(), recording_info(77, mount, prior));
  const auto recording = open_recording(path());
  EXPECT_EQ(recording->info().seed, 77U);
  EXPECT_EQ(recording->info().lidar.packets_per_message, 76);
  EXPECT_TRUE(same_bits(calibration_of(recording->info()).X_RL.q.coeffs(), mount.X_RL.q.coeffs()));
  EXPECT_EQ(prior_of(recording->info()).yaw_W, prior.yaw_W);
  EXPECT_EQ(prior_of(recording->info()).storey, prior.storey);
  for (const SensorFrame& expected : written) {
    SensorFrame frame;
    ASSERT_TRUE(recording->next(frame));
    EXPECT_EQ(frame.scan.stamp, expected.scan.stamp);
    EXPECT_EQ(frame.scan.point_L, expected.scan.point_L);
    EXPECT_EQ(frame.scan.offset_ns, expected.scan.offset_ns);
    ASSERT_EQ(frame.odometry.size(), expected.odometry.size());
    for (std::size_t i = 0; i < frame.odometry.size(); ++i) {
      EXPECT_EQ(frame.odometry[i].stamp, expected.odometry[i].stamp);
      EXPECT_TRUE(same_bits(frame.odometry[i].X_OR.t, expected.odometry[i].X_OR.t));
      EXPECT_TRUE(same_bits(frame.odometry[i].X_OR.q.coeffs(), expected.odometry[i].X_OR.q.coeffs()));
    }
    ASSERT_EQ(frame.imu.size(), expected.imu.size());
    for (std::size_t i = 0; i < frame.imu.size(); ++i) {
      EXPECT_EQ(frame.imu[i].stamp, expected.imu[i].stamp);
      EXPECT_TRUE(same_bits(frame.imu[i].angular_velocity_R, expected.imu[i].angular_velocity_R));
      EXPECT_TRUE(same_bits(frame.imu[i].linear_acceleration_R, expected.imu[i].linear_acceleration_R));
    }
  }
  SensorFrame end;
  EXPECT_FALSE(recording->next(end));
  EXPECT_EQ(recording->origin(), 0);
}

TEST_F(RecordingTest, CovariancesComeBackToTheLastBitWhereTheyAreKnown) {
  for (const bool known : {false, true}) {
    const std::vector<SensorFrame> written = write_three(path(), RecordingInfo{}, known);
    EXPECT_EQ(fs::exists(path("odometry_covariance.csv")), known);
    const auto recording = open_recording(path());
    for (const SensorFrame& expected : written) {
      SensorFrame frame;
      ASSERT_TRUE(recording->next(frame));
      ASSERT_EQ(frame.covariances.size(), expected.covariances.size());
      EXPECT_EQ(frame.covariances.empty(), !known);
      for (std::size_t i = 0; i < frame.covariances.size(); ++i) {
        EXPECT_EQ(frame.covariances[i].stamp, expected.covariances[i].stamp);
        EXPECT_TRUE(
            same_bits(frame.covariances[i].covariance.reshaped(), expected.covariances[i].covariance.reshaped()));
      }
    }
  }
}

TEST_F(RecordingTest, NamesWhatIsWrongWithTheCovariances) {
  static_cast<void>(write_three(path(), RecordingInfo{}, true));
  const std::string file = path("odometry_covariance.csv");
  const std::string header = "t,xx,xy,xz,xa,xb,xc,yy,yz,ya,yb,yc,zz,za,zb,zc,aa,ab,ac,bb,bc,cc\n";
  const std::string zeros = ",0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,";
  put("odometry_covariance.csv", header + "0.01" + zeros + "0\n");
  EXPECT_EQ(complaint(path()), "no error");
  put("odometry_covariance.csv", "t,xx\n");
  expect_complaint(path(), file + ":1:1", "the first line must be");
  put("odometry_covariance.csv", header + "0.01" + zeros + "\n");
  expect_complaint(path(), file + ":2:1", "not 22 numbers");
  put("odometry_covariance.csv", header + "0.01" + zeros + "-1e-9\n");
  expect_complaint(path(), file + ":2:1", "a variance below 0");
  put("odometry_covariance.csv", header + "0.02" + zeros + "0\n0.01" + zeros + "0\n");
  expect_complaint(path(), file + ":3:1", "stamps must increase");
}

TEST_F(RecordingTest, ABareCaptureIsCutAsDriversDoAndHasNoOdometry) {
  write_pcap(path("bare.pcap"), turning_packets(2 * 76 + 30));
  const auto recording = open_recording(path("bare.pcap"));
  EXPECT_FALSE(recording->has_odometry());
  SensorFrame frame;
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(recording->next(frame));
    EXPECT_EQ(frame.scan.columns, 1824);
  }
  EXPECT_FALSE(recording->next(frame));  // 30 packets are no message
}

TEST_F(RecordingTest, PacketsOfATurnFollowTheSpeed) {
  const std::vector<std::pair<int, int>> speeds = {{300, 151}, {600, 76}, {900, 51}, {1200, 38}};
  for (const auto& [rpm, packets] : speeds) {
    std::array<Vlp16Firing, 24> firings;
    for (std::size_t f = 0; f < 24; ++f)
      firings[f].azimuth_cdeg =
          static_cast<std::uint16_t>((35'900 + static_cast<std::int64_t>(f) * 55296 * 6 * rpm / 10'000'000) % 36000);
    EXPECT_EQ(packets_per_turn(encode_packet(0, firings)), packets) << rpm;
  }
}

// Five packets of a motor at half its speed would make messages of two turns.
TEST_F(RecordingTest, AStartingMotorDoesNotTellTheTurn) {
  std::vector<Vlp16Packet> packets = turning_packets(3 * 76);
  for (std::size_t p = 0; p < 5; ++p) {
    std::array<Vlp16Firing, 24> firings;
    for (std::size_t f = 0; f < 24; ++f)
      firings[f].azimuth_cdeg = static_cast<std::uint16_t>(10 * (24 * p + f));  // 1.8 degrees a ms: 300 rpm
    packets[p] = encode_packet(packets[p].stamp, firings);
  }
  write_pcap(path("starting.pcap"), packets);
  const auto recording = open_recording(path("starting.pcap"));
  SensorFrame frame;
  ASSERT_TRUE(recording->next(frame));
  EXPECT_EQ(recording->info().lidar.packets_per_message, 76);
  EXPECT_EQ(frame.scan.columns, 1824);
}

TEST_F(RecordingTest, AMessageBeginsAnewAfterALeapOfTheClock) {
  std::vector<Vlp16Packet> packets = turning_packets(76 + 40);
  const Nanoseconds after = 5'000'000'000;
  for (const Vlp16Packet& packet : turning_packets(2 * 76, after)) packets.push_back(packet);
  write_pcap(path("gap.pcap"), packets);
  const auto recording = open_recording(path("gap.pcap"));
  SensorFrame frame;
  ASSERT_TRUE(recording->next(frame));
  EXPECT_LT(frame.scan.stamp, 200'000'000);
  for (int message = 0; message < 2; ++message) {
    ASSERT_TRUE(recording->next(frame));
    EXPECT_EQ(frame.packets.size(), 76U);
    EXPECT_EQ(frame.packets.front().stamp, packets[static_cast<std::size_t>(116 + 76 * message)].stamp);
  }
  EXPECT_FALSE(recording->next(frame));

  packets = turning_packets(76);
  for (std::size_t p = 0; p < packets.size(); ++p) set_time(packets[p], 40'000'000 * static_cast<Nanoseconds>(p));
  write_pcap(path("gap.pcap"), packets);
  expect_complaint(path("gap.pcap"), path("gap.pcap"), "message 0 lasts more than 2 s");
}

TEST_F(RecordingTest, OdometryThatNoScanMeetsIsRefused) {
  static_cast<void>(write_three(path(), RecordingInfo{}));
  const std::string odometry = path("odometry.tum");
  put("odometry.tum", "");
  expect_complaint(path(), odometry, "no odometry at or before any scan");
  put("odometry.tum", "1000 0 0 0 0 0 0 1\n1000.1 1 0 0 0 0 0 1\n");
  expect_complaint(path(), odometry, "no odometry at or before any scan");
  write_pcap(path("lidar.pcap"), turning_packets(2 * 76, 100'000'000'000));
  fs::remove(path("imu.csv"));
  put("odometry.tum", "0 0 0 0 0 0 0 1\n0.1 1 0 0 0 0 0 1\n");
  expect_complaint(path(), odometry, "the odometry ends before the first scan");
  put("odometry.tum", "0 0 0 0 0 0 0 1\n100.01 1 0 0 0 0 0 1\n");
  EXPECT_EQ(complaint(path()), "no error");
}

TEST_F(RecordingTest, ScansBeforeTheOdometryAreCounted) {
  static_cast<void>(write_three(path(), RecordingInfo{}));
  const auto left_out = [&] {
    const auto recording = open_recording(path());
    for (SensorFrame frame; recording->next(frame);) continue;
    return recording->left_out();
  };
  EXPECT_TRUE(left_out().empty());
  put("odometry.tum", "0.15 0 0 0 0 0 0 1\n0.25 1 0 0 0 0 0 1\n0.35 1 0 0 0 0 0 1\n");
  ASSERT_EQ(left_out().size(), 1U);
  EXPECT_EQ(left_out()[0], "1 of 3 scans left out: before the first odometry");
}

TEST_F(RecordingTest, AForeignCaptureMovesOdometryToItsOwnClock) {
  std::vector<Vlp16Packet> packets = turning_packets(2 * 76, 5'000'000'000);
  const Nanoseconds captured = 1'600'000'000'000'000'123;
  for (std::size_t i = 0; i < packets.size(); ++i) packets[i].stamp += captured - 5'000'000'000;
  write_pcap(path("lidar.pcap"), packets);
  put("odometry.tum", "1599999999.95 0 0 0 0 0 0 1\n1600000000.05 1 0 0 0 0 0 1\n1600000000.15 2 0 0 0 0 0 1\n");
  const auto recording = open_recording(path());
  SensorFrame frame;
  ASSERT_TRUE(recording->next(frame));
  EXPECT_EQ(recording->origin(), captured);
  ASSERT_EQ(frame.odometry.size(), 2U);
  EXPECT_EQ(frame.odometry[0].stamp, -50'000'123);
  EXPECT_EQ(frame.odometry[1].X_OR.t.x(), 1.0);
}

TEST_F(RecordingTest, ScansBeforeTheFirstOdometryAreLeftOut) {
  static_cast<void>(write_three(path(), RecordingInfo{}));
  put("odometry.tum", "0.15 0 0 0 0 0 0 1\n0.25 1 0 0 0 0 0 1\n");
  const auto recording = open_recording(path());
  SensorFrame frame;
  ASSERT_TRUE(recording->next(frame));
  EXPECT_GT(frame.scan.stamp, 150'000'000);
  EXPECT_EQ(frame.odometry.size(), 1U);
  EXPECT_GT(frame.imu.size(), 40U);  // those of the scans left out, too
}

TEST_F(RecordingTest, ALongCaptureNeedsNoMoreMemoryThanAShortOne) {
  const auto peak_mb = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss / 1024;
  };
  const std::vector<Vlp16Packet> turn = turning_packets(76);
  const auto read_all = [&](int messages) {
    PcapWriter writer(path("long.pcap"));
    for (int p = 0; p < 76 * messages; ++p) {
      Vlp16Packet packet = turn[static_cast<std::size_t>(p % 76)];
      packet.stamp = p * 24 * vlp16::firing_period_ns;
      const auto us = static_cast<std::uint32_t>(packet.stamp / 1000);
      std::memcpy(&packet.payload[1200], &us, 4);
      writer.add(packet);
    }
    writer.finish();
    const auto recording = open_recording(path("long.pcap"));
    int count = 0;
    for (SensorFrame frame; recording->next(frame);) ++count;
    EXPECT_EQ(count, messages);
  };
  read_all(20);
  const auto before = peak_mb();
  read_all(600);  // 58 MB
  EXPECT_LT(peak_mb() - before, 8) << before;
}

TEST_F(RecordingTest, NamesWhatIsWrongWithPackets) {
  std::vector<Vlp16Packet> packets = turning_packets(100);
  const auto with = [&](std::size_t i, const auto& change) {
    std::vector<Vlp16Packet> changed = packets;
    change(changed[i]);
    write_pcap(path("bad.pcap"), changed);
    return path("bad.pcap");
  };
  const std::string bad = path("bad.pcap");
  EXPECT_EQ(complaint(with(0, [](Vlp16Packet&) {})), "no error");
  expect_complaint(with(3, [](Vlp16Packet& p) { p.payload[1205] = 0x28; }), bad, "from different sensors");
  expect_complaint(with(3, [](Vlp16Packet& p) { p.payload[1205] = 0x41; }), bad, "product 65");
  expect_complaint(with(3, [](Vlp16Packet& p) { p.payload[300] = 0; }), bad, "flag");
  expect_complaint(with(9, [&](Vlp16Packet& p) { p = packets[3]; }), bad, "frame 12: its time lies");
  expect_complaint(with(9, [&](Vlp16Packet& p) { p.stamp += 5'000'000; }), bad, "frame 12: its time of capture");
  expect_complaint(with(9, [](Vlp16Packet& p) { p.payload[1203] = 0xff; }), bad, "frame 12: its time");
  std::vector<Vlp16Packet> leap = turning_packets(40);
  for (Vlp16Packet& packet : turning_packets(40, 200'000'000'000)) leap.push_back(packet);
  write_pcap(bad, leap);
  expect_complaint(bad, bad, "the clock leaps by");
  write_pcap(bad, turning_packets(40));
  expect_complaint(bad, bad, "holds 40 data packets; one scan needs 76");
  fs::resize_file(bad, 24 + 20 * 1264 + 700);
  expect_complaint(bad, bad, "holds 18 data packets; one scan needs 76");
}

TEST_F(RecordingTest, ACutOffCaptureIsReadUnlessItsDigestIsKnown) {
  for (const bool simulated : {false, true}) {
    RecordingInfo info;
    if (simulated) info.walk = "0123456789abcdef";
    const std::string dir = path(simulated ? "simulated" : "real");
    fs::create_directory(dir);
    static_cast<void>(write_three(dir, info));
    const std::string pcap = dir + "/lidar.pcap";
    fs::resize_file(pcap, fs::file_size(pcap) - 1);
    const auto recording = open_recording(dir, &info);
    const std::string complaint = input_error([&] {
      int scans = 0;
      for (SensorFrame frame; recording->next(frame);) ++scans;
      EXPECT_EQ(scans, 2);
      EXPECT_EQ(recording->left_out(), std::vector<std::string>{"the capture is cut off; read as far as it is whole"});
    });
    EXPECT_EQ(complaint, simulated ? pcap + ": damaged capture: truncated" : "no error");
  }
}

TEST_F(RecordingTest, NamesWhatIsWrongWithTheFilesBesides) {
  static_cast<void>(write_three(path(), RecordingInfo{}));
  const std::string odometry = path("odometry.tum"), imu = path("imu.csv"), info = path("recording.yaml");
  put("odometry.tum", "0.1 0 0 0 0 0 0 1\n0.05 0 0 0 0 0 0 1\n");
  expect_complaint(path(), odometry + ":2:1", "stamps must increase");
  put("odometry.tum", "0.1 0 0 nan 0 0 0 1\n");
  expect_complaint(path(), odometry + ":1:1", "not a number");
  put("odometry.tum", std::string(10'000, 'x'));
  expect_complaint(path(), odometry + ":1:1", "4095 characters");
  put("odometry.tum", "0 0 0 0 0 0 0 1\n");
  put("imu.csv", "0,0,0,0,0,0,0\n");
  expect_complaint(path(), imu + ":1:1", "the first line must be");
  put("imu.csv", "t,wx,wy,wz,ax,ay,az\n0,0,0,0,0,0,9.81\n0.004,0,0,0,0,inf,9.81\n");
  expect_complaint(path(), imu + ":3:1", "not 7 numbers");
  put("imu.csv", "t,wx,wy,wz,ax,ay,az\n0,0,0,0,0,0,9.81,3\n");
  expect_complaint(path(), imu + ":2:1", "not 7 numbers");
  put("imu.csv", "t,wx,wy,wz,ax,ay,az\n");
  EXPECT_EQ(complaint(path()), "no error");
  put("recording.yaml", "recording: 1\nmount: {position_m: [1, 2]}\n");
  expect_complaint(path(), info + ":2:", "3 numbers");
  put("recording.yaml", "recording: 1\nmount: {quaternion_xyzw: [1, 1, 0, 0]}\n");
  expect_complaint(path(), info + ":2:", "norm");
  put("recording.yaml", "recording: 1\nmount: {quaternion_xyzw: [1e200, 1, 0, 0]}\n");
  expect_complaint(path(), info + ":2:", "norm");
  put("recording.yaml", "recording: 1\nmount: {position_m: [1e200, 0, 0]}\n");
  expect_complaint(path(), info + ":2:", "at most 100 m");
  put("recording.yaml", "recording: 1\nmont: {}\n");
  expect_complaint(path(), info + ":2:", "'mount'");
  fs::remove(path("lidar.pcap"));
  expect_complaint(path(), path(), "no lidar.pcap");
}

}  // namespace
}  // namespace plumbline::slam
