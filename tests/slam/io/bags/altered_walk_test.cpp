// SPDX-License-Identifier: Apache-2.0
// Bags whose messages are not as their fields' names say.
#include "tests/slam/io/bags/altered_walk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "tests/folder.h"
#include "tests/input_error.h"

namespace plumbline::slam {
namespace {

struct Read {
  std::vector<SensorFrame> frames;
  std::vector<std::string> left_out, assumed;
  Taken taken;
};

class AlteredWalk : public ::testing::Test {
 protected:
  Read read(const Alteration& alteration) {
    const std::string path = folder_ / ("walk" + std::to_string(written_++));
    write_altered(path, alteration);
    const auto recording = open_bag(path, {}, nullptr);
    Read out;
    for (SensorFrame frame; recording->next(frame);) out.frames.push_back(frame);
    out.left_out = recording->left_out();
    out.assumed = recording->assumed();
    out.taken = recording->taken();
    return out;
  }
  static Nanoseconds length(const Scan& scan) {
    return -*std::min_element(scan.offset_ns.begin(), scan.offset_ns.end());
  }

 private:
  Folder folder_;
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
      "/velodyne_points: point times from 0 to 1 are taken as shares of a sweep of 101 ms; clouds are 101 ms apart");
  ASSERT_EQ(read_shares.frames.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(static_cast<double>(read_shares.frames[i].scan.stamp - plain.frames[i].scan.stamp), 0.0, 1e5);
}

TEST_F(AlteredWalk, RingsOfOneNumberAreLeftOutAndSaid) {
  Alteration constant;
  constant.cloud = [](int, PointCloud& cloud) {
    change_field<std::uint16_t>(cloud, ring_offset, [](std::uint16_t) { return std::uint16_t{0}; });
  };
  const Read plain = read({}), altered = read(constant);
  ASSERT_EQ(altered.left_out.size(), 1U);
  EXPECT_EQ(altered.left_out[0],
            "/velodyne_points: 4 of 4 scans read without their ring numbers, which are one for all points");
  ASSERT_EQ(altered.frames.size(), plain.frames.size());
  for (std::size_t i = 0; i < plain.frames.size(); ++i)
    EXPECT_EQ(altered.frames[i].scan.point_L, plain.frames[i].scan.point_L);
}

}  // namespace
}  // namespace plumbline::slam
