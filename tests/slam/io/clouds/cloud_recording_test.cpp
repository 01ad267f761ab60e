// SPDX-License-Identifier: Apache-2.0
#include "slam/io/clouds/cloud_recording.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "bim/errors.h"
#include "slam/io/clouds/cloud_file.h"
#include "slam/io/packets/point_cloud.h"
#include "tests/folder.h"
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
