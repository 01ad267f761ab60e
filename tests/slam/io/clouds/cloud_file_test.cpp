// SPDX-License-Identifier: Apache-2.0
#include "slam/io/clouds/cloud_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <limits>
#include <string>

#include "bim/config/tree.h"
#include "bim/errors.h"
#include "slam/io/packets/point_cloud.h"
#include "tests/folder.h"
#include "tests/slam/io/packets/packets.h"

namespace plumbline::slam {
namespace {

Scan some_scan() { return decode_message(turning_packets(76)); }

void write_text(const std::string& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }

class CloudFileTest : public testing::TestWithParam<std::string> {
 protected:
  Folder folder_;
  std::string file_ = folder_ / ("cloud." + GetParam());
};

TEST_P(CloudFileTest, AScanComesBackWithRingsAndTimes) {
  const Scan scan = some_scan();
  for (const CloudLayout layout : {CloudLayout::organised, CloudLayout::dense}) {
    const PointCloud cloud = cloud_of(scan, layout);
    write_cloud_file(file_, cloud);
    PointCloud back = read_cloud_file(file_);
    ASSERT_EQ(back.fields.size(), cloud.fields.size());
    for (std::size_t k = 0; k < cloud.fields.size(); ++k) {
      EXPECT_EQ(back.fields[k].name, cloud.fields[k].name);
      EXPECT_EQ(back.fields[k].type, cloud.fields[k].type);
    }
    EXPECT_EQ(back.data, cloud.data);
    EXPECT_EQ(back.height, GetParam() == "ply" ? 1U : cloud.height) << "a .ply has no rows";
    back.stamp = cloud.stamp;
    const Scan again = scan_of(back), direct = scan_of(cloud);
    EXPECT_EQ(again.stamp, direct.stamp);
    EXPECT_EQ(again.rings, direct.rings);
  }
}

TEST_P(CloudFileTest, TheSamePointsAreTheSameBytes) {
  const PointCloud cloud = cloud_of(some_scan(), CloudLayout::dense);
  write_cloud_file(file_, cloud);
  const std::string first = read_text_file(file_);
  write_cloud_file(file_, cloud);
  EXPECT_EQ(read_text_file(file_), first);
}

TEST_P(CloudFileTest, PointsComeBackToTheBit) {
  const std::vector<Eigen::Vector3f> points = {{1.5F, -2.0F, 1e-9F}, {0.0F, 3.25F, 1e9F}};
  write_cloud_file(file_, cloud_of(points));
  EXPECT_EQ(read_cloud_points(file_), points);
  write_cloud_file(file_, cloud_of(std::vector<Eigen::Vector3f>{}));
  EXPECT_TRUE(read_cloud_points(file_).empty());
  EXPECT_THROW((void)cloud_of(std::vector<Eigen::Vector3f>{{std::numeric_limits<float>::quiet_NaN(), 0, 0}}),
               InternalError);
}

TEST_P(CloudFileTest, ShortFilesAreRefused) {
  write_cloud_file(file_, cloud_of(std::vector<Eigen::Vector3f>{{1, 2, 3}, {4, 5, 6}}));
  const std::string bytes = read_text_file(file_);
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    write_text(file_, bytes.substr(0, n));
    EXPECT_THROW((void)read_cloud_file(file_), InputError) << n;
  }
}

TEST_P(CloudFileTest, WhatCannotBeWrittenIsSaid) {
  EXPECT_THROW(write_cloud_file(folder_ / ("no/such/folder." + GetParam()), cloud_of(some_scan(), CloudLayout::dense)),
               EnvironmentError);
  EXPECT_THROW(write_cloud_file(folder_ / ("no/such/folder." + GetParam()), PointCloud{}), EnvironmentError);
}

INSTANTIATE_TEST_SUITE_P(Endings, CloudFileTest, testing::Values("pcd", "ply"),
                         [](const auto& info) { return info.param; });

TEST(CloudFile, ReadsWhatOthersWrite) {
  const Folder folder;
  const std::vector<Eigen::Vector3f> expected = {{1, 2, 3}, {4, 5, 6}};
  const std::string fields =
      "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\n";
  write_text(folder / "a.pcd", fields + "DATA ascii\n1 2 3\n4 5 6\n");
  EXPECT_EQ(read_cloud_points(folder / "a.pcd"), expected);
  // LZF, field by field: one run of 24 bytes as they are.
  std::string packed = fields + "DATA binary_compressed\n";
  for (const std::uint32_t size : {25U, 24U}) packed.append(reinterpret_cast<const char*>(&size), 4);
  packed += static_cast<char>(23);
  for (const float value : {1.0F, 4.0F, 2.0F, 5.0F, 3.0F, 6.0F})
    packed.append(reinterpret_cast<const char*>(&value), 4);
  write_text(folder / "b.pcd", packed);
  EXPECT_EQ(read_cloud_points(folder / "b.pcd"), expected);
  write_text(folder / "c.ply",
             "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
             "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n1 2 3 9 9 9\n4 5 6 9 9 9\n");
  EXPECT_EQ(read_cloud_points(folder / "c.ply"), expected);
}

TEST(CloudFile, DamagedBodiesAreRefusedOrHoldNoPlace) {
  const Folder folder;
  const std::string fields =
      "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\n";
  std::string packed = fields + "DATA binary_compressed\n";
  for (const std::uint32_t size : {25U, 24U}) packed.append(reinterpret_cast<const char*>(&size), 4);
  for (const char control : {'\377', '\0', '\40'}) {  // copies from before the start; ends early
    write_text(folder / "a.pcd", packed + control + std::string(24, control));
    EXPECT_THROW((void)read_cloud_file(folder / "a.pcd"), InputError) << static_cast<int>(control);
  }
  write_text(folder / "b.pcd", fields + "DATA ascii\n1 2 3\none two three\n");
  try {
    const std::vector<Eigen::Vector3f> points = read_cloud_points(folder / "b.pcd");
    ASSERT_FALSE(points.empty());
    EXPECT_EQ(points.front(), Eigen::Vector3f(1, 2, 3));
    if (points.size() > 1) {
      EXPECT_TRUE(points[1].isZero(0.0F)) << "which is no return";
    }
  } catch (const InputError&) {
  }
}

TEST(CloudFile, PointsMayBeDoubles) {
  const Folder folder;
  std::string ply =
      "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty double x\nproperty double y\n"
      "property double z\nend_header\n";
  for (const double value : {1.0, 2.0, 3.0, 4.0, 5.0, 6.0}) ply.append(reinterpret_cast<const char*>(&value), 8);
  write_text(folder / "a.ply", ply);
  EXPECT_EQ(read_cloud_points(folder / "a.ply"), (std::vector<Eigen::Vector3f>{{1, 2, 3}, {4, 5, 6}}));
}

TEST(CloudFile, PointsNeedFloats) {
  PointCloud cloud = cloud_of(std::vector<Eigen::Vector3f>{{1, 2, 3}});
  cloud.fields[1].type = PointType::u32;
  EXPECT_THROW((void)points_of(cloud, {}), InputError);
}

}  // namespace
}  // namespace plumbline::slam
