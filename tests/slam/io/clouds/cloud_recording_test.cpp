// SPDX-License-Identifier: Apache-2.0
#include "slam/io/clouds/cloud_recording.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include "bim/errors.h"
#include "slam/io/clouds/cloud_file.h"
#include "slam/io/clouds/name_order.h"
#include "slam/io/packets/point_cloud.h"
#include "tests/folder.h"
#include "tests/input_error.h"
#include "tests/slam/io/clouds/bin_file.h"
#include "tests/slam/io/packets/made_cloud.h"
#include "tests/slam/io/packets/packets.h"

namespace plumbline::slam {
namespace {

void write_clouds(const Folder& folder, const std::vector<std::string>& names) {
  const PointCloud cloud = cloud_of(decode_message(turning_packets(76)), CloudLayout::dense);
  for (const std::string& name : names) write_cloud_file(folder / name, cloud);
}

TEST(CloudRecording, IsAScanEachTenthOfASecond) {
  const Folder folder;
  write_clouds(folder, {"01.pcd", "00.pcd", "02.pcd"});
  ASSERT_TRUE(is_cloud_folder(folder.path()));
  const auto recording = open_cloud_folder(folder.path());
  EXPECT_FALSE(recording->has_odometry());
  EXPECT_EQ(recording->origin(), 0);
  const Scan scan = scan_of(cloud_of(decode_message(turning_packets(76)), CloudLayout::dense));
  SensorFrame frame;
  Nanoseconds before = 0;
  for (int k = 0; k < 3; ++k) {
    ASSERT_TRUE(recording->next(frame)) << k;
    EXPECT_TRUE(frame.odometry.empty());
    EXPECT_EQ(frame.scan.columns, scan.columns);
    EXPECT_EQ(frame.scan.range_m, scan.range_m);
    if (k > 0) {
      EXPECT_EQ(frame.scan.stamp - before, 100'000'000);
    }
    before = frame.scan.stamp;
  }
  EXPECT_FALSE(recording->next(frame));
}

TEST(CloudRecording, AClockThatGoesBackByMoreThanASecondIsAnError) {
  for (const auto& [third, scans] : {std::pair("9.5", 3), {"8.9", 2}}) {
    const Folder folder;
    write_clouds(folder, {"0.pcd", "1.pcd", "2.pcd", "3.pcd"});
    write_raw(folder / "times.txt", "9.9\n10\n" + std::string(third) + "\n10.2\n");
    const auto recording = open_cloud_folder(folder.path());
    SensorFrame frame;
    int read = 0;
    const std::string error = input_error([&] {
      while (recording->next(frame)) ++read;
    });
    EXPECT_EQ(read, scans) << third;
    EXPECT_EQ(error == "no error", scans == 3) << error;
    if (scans == 2) {
      EXPECT_NE(error.find("2.pcd: times of clouds go back by 1100 ms"), std::string::npos) << error;
    }
  }
}

TEST(CloudRecording, EndingsMayBeInCapitals) {
  for (const char* ending : {".PCD", ".Ply"}) {
    const Folder folder;
    write_clouds(folder, {"0" + std::string(ending), "1" + std::string(ending)});
    ASSERT_TRUE(is_cloud_folder(folder.path())) << ending;
    const auto recording = open_cloud_folder(folder.path());
    SensorFrame frame;
    EXPECT_TRUE(recording->next(frame) && recording->next(frame) && !recording->next(frame)) << ending;
  }
}

TEST(CloudRecording, AScanEachPeriodThatTheDescriptionTells) {
  const Folder folder;
  write_clouds(folder, {"0.pcd", "1.pcd"});
  RecordingInfo info;
  info.lidar.period_s = 0.5;
  const auto recording = open_cloud_folder(folder.path(), &info);
  SensorFrame first, second;
  ASSERT_TRUE(recording->next(first));
  ASSERT_TRUE(recording->next(second));
  EXPECT_EQ(second.scan.stamp - first.scan.stamp, 500'000'000);
  info.lidar.period_s = 0.05;  // and a turn of 0.1 s
  EXPECT_THROW((void)open_cloud_folder(folder.path(), &info)->next(first), InputError);
}

TEST(CloudRecording, HasTheOdometryThatLiesBesideTheClouds) {
  const Folder folder;
  write_clouds(folder, {"0.pcd", "1.pcd"});
  std::ofstream(folder / "odometry.tum") << "0 1 2 3 0 0 0 1\n";
  std::ofstream(folder / "imu.csv") << "t,wx,wy,wz,ax,ay,az\n0,0,0,1,0,0,9.8\n";
  ASSERT_TRUE(is_cloud_folder(folder.path()));
  const auto recording = open_cloud_folder(folder.path());
  EXPECT_TRUE(recording->has_odometry());
  SensorFrame frame;
  ASSERT_TRUE(recording->next(frame));
  EXPECT_EQ(frame.odometry.at(0).X_OR.t, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(frame.imu.size(), 1U);
  const Folder elsewhere;
  std::ofstream(elsewhere / "other.tum") << "0 4 5 6 0 0 0 1\n";
  const auto given = open_cloud_folder(folder.path(), nullptr, {elsewhere / "other.tum", {}});
  ASSERT_TRUE(given->next(frame));
  EXPECT_EQ(frame.odometry.at(0).X_OR.t, Eigen::Vector3d(4, 5, 6));
}

TEST(CloudRecording, OrdersNamesByTheirNumbers) {
  const auto widths = [](const std::vector<std::string>& names) {
    const Folder folder;
    for (std::size_t i = 0; i < names.size(); ++i)  // the i-th name in the right order has i + 1 points
      write_cloud_file(folder / names[i],
                       cloud_with({"x", "y", "z"}, std::vector<std::vector<float>>(i + 1, {1, 2, 3})));
    const auto recording = open_cloud_folder(folder.path());
    std::vector<int> columns;
    for (SensorFrame frame; recording->next(frame);) columns.push_back(frame.scan.columns);
    return columns;
  };
  const std::vector<int> rising = {1, 2, 3, 4};
  EXPECT_EQ(widths({"0.pcd", "2.pcd", "10.pcd", "100.pcd"}), rising);
  EXPECT_EQ(widths({"s1_9.ply", "s1_10.ply", "s2_1.ply", "s10_0.ply"}), rising);
  EXPECT_EQ(widths({"17.45.pcd", "17.5.pcd", "18.05.pcd", "18.1.pcd"}), rising) << "fractions of a second";
  EXPECT_EQ(widths({"0007.pcd", "0010.pcd", "0100.pcd", "a.pcd"}), rising);
}

TEST(NameOrder, IsAStrictWeakOrder) {
  const std::vector<std::string> names = {"",
                                          "x",
                                          "x1",
                                          "x01",
                                          "x1.pcd",
                                          "x01.pcd",
                                          "x1.pcd.a.pcd",
                                          "x01.pcd.b.pcd",
                                          "x1.pcd.b.pcd",
                                          "x10.pcd",
                                          "x2.pcd",
                                          "0",
                                          "00",
                                          "000",
                                          "0a",
                                          "00a",
                                          "1.5",
                                          "1.50",
                                          "1.05",
                                          "01.5",
                                          "01.50.a",
                                          "1.5.2",
                                          "1..5",
                                          ".5",
                                          ".50",
                                          "0.5",
                                          "a.5",
                                          "1.a",
                                          "1.10",
                                          "1-10",
                                          "1 10",
                                          "x1.",
                                          "x01.0",
                                          "\xc3\xa9"
                                          "1",
                                          "9",
                                          "99999999999999999999"};
  for (const std::string& a : names) {
    for (const std::string& b : names) {
      EXPECT_EQ(is_earlier_name(a, b) || is_earlier_name(b, a), a != b) << a << " | " << b;
      EXPECT_FALSE(is_earlier_name(a, b) && is_earlier_name(b, a)) << a << " | " << b;
      for (const std::string& c : names)
        if (is_earlier_name(a, b) && is_earlier_name(b, c))
          EXPECT_TRUE(is_earlier_name(a, c)) << a << " | " << b << " | " << c;
    }
  }
}

TEST(CloudRecording, TakesTimesFromZeroToOneAsSharesOfAPeriod) {
  const Folder folder;
  for (const char* name : {"0.pcd", "1.pcd", "2.pcd"}) {
    std::vector<std::vector<float>> points;
    for (int k = 0; k < 100; ++k) {
      const float share = static_cast<float>(k) / 99.0F;
      points.push_back({2.0F + share, 1.0F, 0.1F, share});
    }
    write_cloud_file(folder / name, cloud_with({"x", "y", "z", "time"}, points));
  }
  const auto recording = open_cloud_folder(folder.path());
  ASSERT_EQ(recording->assumed().size(), 2U);
  EXPECT_NE(recording->assumed().back().find("one each 0.1 s is assumed"), std::string::npos);
  EXPECT_NE(recording->assumed().front().find("shares of a scan of 100 ms"), std::string::npos);
  SensorFrame frame;
  for (int k = 0; k < 3; ++k) {
    ASSERT_TRUE(recording->next(frame)) << k;
    EXPECT_EQ(frame.scan.stamp, (k + 1) * 100'000'000);
  }
}

/// Ten points with times of their own, 10 ms apart.
PointCloud cloud_of_times(double first_s) {
  PointCloud cloud;
  cloud.fields = {
      {"x", 0, PointType::f32}, {"y", 4, PointType::f32}, {"z", 8, PointType::f32}, {"t", 12, PointType::f64}};
  cloud.point_step = 20;
  cloud.width = 10;
  cloud.height = 1;
  cloud.row_step = 200;
  cloud.data.resize(200);
  for (std::size_t k = 0; k < 10; ++k) {
    const float one = 1.0F + static_cast<float>(k);
    const double t = first_s + 0.01 * static_cast<double>(k);
    for (std::size_t a = 0; a < 3; ++a) std::memcpy(&cloud.data[20 * k + 4 * a], &one, sizeof one);
    std::memcpy(&cloud.data[20 * k + 12], &t, sizeof t);
  }
  return cloud;
}

TEST(CloudRecording, TimesThatRunOnAreTheScansOwn) {
  const Folder folder;
  constexpr int clouds = 30;
  constexpr double apart_s = 0.15;  // not the period: by it, the last cloud would be 1.45 s late
  for (int i = 0; i < clouds; ++i) write_cloud_file(folder / (std::to_string(i) + ".pcd"), cloud_of_times(apart_s * i));
  const auto recording = open_cloud_folder(folder.path());
  SensorFrame frame;
  for (int i = 0; i < clouds; ++i) {
    ASSERT_TRUE(recording->next(frame)) << i;
    EXPECT_NEAR(1e-9 * static_cast<double>(frame.scan.stamp), apart_s * i + 0.09, 1e-6) << i;
  }
}

std::vector<Nanoseconds> stamps_in(Recording& recording) {
  std::vector<Nanoseconds> stamps;
  for (SensorFrame frame; recording.next(frame);) stamps.push_back(frame.scan.stamp);
  return stamps;
}

/// KITTI's layout, with so many clouds.
void write_velodyne(const Folder& folder, int clouds) {
  std::filesystem::create_directory(folder / "velodyne");
  for (int i = 0; i < clouds; ++i)
    write_floats(folder / ("velodyne/00000" + std::to_string(i) + ".bin"), {3, 4, 0, 0.5F, 5, 6, 0, 0.25F});
}

TEST(CloudRecording, ReadsKittisSequences) {
  const Folder folder;
  write_velodyne(folder, 3);
  write_raw(folder / "times.txt", "0.000000e+00\n1.036224e-01\n2.072470e-01\n");
  write_raw(folder / "calib.txt", "P0:\n");
  for (const std::string& path : {folder.path(), folder / "velodyne", folder / "velodyne/"}) {
    ASSERT_TRUE(is_cloud_folder(path)) << path;
    const auto recording = open_cloud_folder(path);
    EXPECT_EQ(stamps_in(*recording), (std::vector<Nanoseconds>{0, 103'622'400, 207'247'000}));
    EXPECT_EQ(recording->origin(), 0);
    EXPECT_TRUE(recording->left_out().empty());
    EXPECT_TRUE(recording->assumed().empty());
  }
}

TEST(CloudRecording, TakesNamesThatAreStampsForThem) {
  const Folder folder;
  write_clouds(folder, {"1700000000000000000.pcd", "1700000000200000000.pcd", "1700000000450000000.pcd"});
  const auto recording = open_cloud_folder(folder.path());
  EXPECT_EQ(recording->assumed(), std::vector<std::string>{"the names of the clouds are taken for their stamps"});
  const std::vector<Nanoseconds> stamps = stamps_in(*recording);
  ASSERT_EQ(stamps.size(), 3U);
  EXPECT_EQ(stamps[1] - stamps[0], 200'000'000);
  EXPECT_EQ(stamps[2] - stamps[1], 250'000'000);
}

TEST(CloudRecording, SaysThatTheRateOfBareCloudsIsNotKnown) {
  const Folder folder;
  write_velodyne(folder, 2);
  const auto recording = open_cloud_folder(folder / "velodyne");
  ASSERT_EQ(recording->assumed().size(), 1U);
  EXPECT_NE(recording->assumed().front().find("one each 0.1 s is assumed"), std::string::npos);
  EXPECT_EQ(stamps_in(*recording), (std::vector<Nanoseconds>{0, 100'000'000}));
  RecordingInfo info;
  info.lidar.period_s = 0.05;
  const auto described = open_cloud_folder(folder / "velodyne", &info);
  EXPECT_TRUE(described->assumed().empty());
  EXPECT_EQ(stamps_in(*described), (std::vector<Nanoseconds>{0, 50'000'000}));
}

TEST(CloudRecording, KeepsTheClockOfTheDay) {
  const Folder folder;
  write_clouds(folder, {"0.pcd", "1.pcd"});
  write_raw(folder / "timestamps.txt", "2011-09-26 13:02:25.5\n2011-09-26 13:02:25.75\n");
  const auto recording = open_cloud_folder(folder.path());
  const std::vector<Nanoseconds> stamps = stamps_in(*recording);
  ASSERT_EQ(stamps.size(), 2U);
  EXPECT_EQ(stamps[1] - stamps[0], 250'000'000);
  EXPECT_LT(stamps[0], 200'000'000) << "the end of the first turn";
  EXPECT_EQ(recording->origin(), 1'317'042'145'500'000'000);
}

// As of drivers that stamp a turn at its end; the clock of the day starts at the first of the stamps.
TEST(CloudRecording, TimesBeforeTheStampLoseNoScan) {
  const Folder folder;
  constexpr int clouds = 30;
  std::string times;
  for (int i = 0; i < clouds; ++i) {
    write_cloud_file(folder / (std::to_string(i) + ".pcd"), cloud_of_times(-0.1));
    times += std::to_string(1'600'000'000 + i) + ".5\n";
  }
  write_raw(folder / "times.txt", times);
  const auto recording = open_cloud_folder(folder.path());
  EXPECT_EQ(stamps_in(*recording).size(), static_cast<std::size_t>(clouds));
  EXPECT_TRUE(recording->left_out().empty());
}

TEST(CloudRecording, LeavesOutCloudsWhoseTimesGoBack) {
  const Folder folder;
  write_velodyne(folder, 5);
  write_raw(folder / "times.txt", "1\n2\n1.5\n2\n3\n");
  const auto recording = open_cloud_folder(folder.path());
  EXPECT_EQ(stamps_in(*recording), (std::vector<Nanoseconds>{1'000'000'000, 2'000'000'000, 3'000'000'000}));
  ASSERT_EQ(recording->left_out().size(), 1U);
  EXPECT_EQ(recording->left_out().front().find("2 of 5 scans left out"), 0U);
  write_raw(folder / "times.txt", "5\n4\n3\n2\n1\n");
  EXPECT_THROW((void)stamps_in(*open_cloud_folder(folder.path())), InputError);
}

TEST(CloudRecording, WarnsOfPointsThatAreTooFar) {
  const Folder folder;
  write_floats(folder / "0.bin", {3000, 4000, 10, 0, 30, 40, 10, 0, 700, 0, 0, 0});
  write_raw(folder / "times.txt", "0\n");
  const auto recording = open_cloud_folder(folder.path());
  (void)stamps_in(*recording);
  ASSERT_EQ(recording->assumed().size(), 1U);
  EXPECT_NE(recording->assumed().front().find("divide them by 1000"), std::string::npos);
}

TEST(CloudRecording, SaysWhatKeepsAFolderFromBeingOne) {
  const Folder folder;
  EXPECT_EQ(why_no_cloud_folder(folder.path()), "");
  write_clouds(folder, {"0.pcd", "1.pcd", "2.pcd"});
  EXPECT_EQ(why_no_cloud_folder(folder.path()), "");
  std::ofstream(folder / "calib.txt") << "P0\n";
  EXPECT_NE(why_no_cloud_folder(folder.path()).find("beside them 'calib.txt'"), std::string::npos);
  std::filesystem::remove(folder / "calib.txt");
  write_clouds(folder, {"0.ply"});
  EXPECT_NE(why_no_cloud_folder(folder.path()).find("more than one ending"), std::string::npos);
  for (const char* name : {"0.pcd", "1.pcd", "2.pcd", "0.ply"}) std::filesystem::remove(folder / name);
  for (const char* name : {"a.json", "b.json"}) std::ofstream(folder / name) << "{}";
  write_clouds(folder, {"map.ply"});
  EXPECT_EQ(why_no_cloud_folder(folder.path()), "") << "a run's folder";
}

TEST(CloudRecording, TakesTheDescription) {
  const Folder folder;
  write_clouds(folder, {"a.ply"});
  EXPECT_EQ(open_cloud_folder(folder.path())->info().mount.height_m, RecordingInfo{}.mount.height_m);
  std::ofstream(folder / "recording.yaml") << "recording: 1\nmount: {height_m: 1.5}\n";
  ASSERT_TRUE(is_cloud_folder(folder.path()));
  EXPECT_EQ(open_cloud_folder(folder.path())->info().mount.height_m, 1.5);
  RecordingInfo info;
  info.mount.height_m = 0.3;
  EXPECT_EQ(open_cloud_folder(folder.path(), &info)->info().mount.height_m, 0.3);
}

TEST(CloudRecording, NothingElseIsOne) {
  const Folder folder;
  EXPECT_FALSE(is_cloud_folder(folder / "nothing"));
  EXPECT_FALSE(is_cloud_folder(folder.path()));
  EXPECT_THROW((void)open_cloud_folder(folder.path()), InputError);
  write_clouds(folder, {"a.ply"});
  EXPECT_TRUE(is_cloud_folder(folder.path()));
  write_clouds(folder, {"b.pcd"});
  EXPECT_FALSE(is_cloud_folder(folder.path())) << "two endings";
  std::filesystem::remove(folder / "b.pcd");
  std::ofstream(folder / "results.json") << "{}";
  EXPECT_FALSE(is_cloud_folder(folder.path())) << "a run's folder";
}

TEST(CloudRecording, NamesTheFileThatIsWrong) {
  const Folder folder;
  write_clouds(folder, {"0.pcd"});
  std::ofstream(folder / "1.pcd") << "nonsense";
  const auto recording = open_cloud_folder(folder.path());
  SensorFrame frame;
  ASSERT_TRUE(recording->next(frame));
  try {
    (void)recording->next(frame);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("1.pcd"), std::string::npos);
  }
}

}  // namespace
}  // namespace plumbline::slam
