// SPDX-License-Identifier: Apache-2.0
#include "slam/io/clouds/bin_cloud.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "bim/errors.h"
#include "slam/io/packets/point_cloud.h"
#include "tests/folder.h"
#include "tests/input_error.h"
#include "tests/slam/io/clouds/bin_file.h"

namespace plumbline::slam {
namespace {

TEST(BinCloud, HoldsKittisPoints) {
  const Folder folder;
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  write_floats(folder / "0.bin", {1, 2, 3, 0.5F, nan, 1, 1, 0, 4, 5, 6, 1, inf, 0, 0, 0, 7, 8, 9, 0});
  const Scan scan = scan_of(read_bin_cloud(folder / "0.bin"));
  EXPECT_EQ(scan.rings, 1);
  std::vector<double> xs;
  for (std::size_t i = 0; i < scan.size(); ++i)
    if (scan.range_m[i] > 0.0) xs.push_back(scan.point_L[i].x());
  EXPECT_EQ(xs, (std::vector<double>{1, 4, 7}));
}

TEST(BinCloud, HoldsTheRingOfNuScenes) {
  const Folder folder;
  write_floats(folder / "0.pcd.bin", {1, 0, 0, 9, 0, 0, 1, 1, 9, 1});
  const PointCloud cloud = read_bin_cloud(folder / "0.pcd.bin");
  EXPECT_EQ(cloud.width, 2U);
  EXPECT_EQ(cloud.fields.back().name, "ring");
  EXPECT_GT(scan_of(cloud).rings, 1);
}

/// A turn of 1,000 points in a hall, of so many numbers each.
std::vector<float> turn_of(std::size_t numbers) {
  std::vector<float> values;
  for (int i = 0; i < 1000; ++i) {
    const float angle = 0.00628F * static_cast<float>(i);
    const std::vector<float> point = {9 * std::cos(angle),
                                      6 * std::sin(angle),
                                      -0.5F,
                                      static_cast<float>(i % 7 * 9),
                                      7.0F,
                                      0.1F * static_cast<float>(i % 11)};
    values.insert(values.end(), point.begin(), point.begin() + static_cast<std::ptrdiff_t>(numbers));
  }
  return values;
}

TEST(BinCloud, PointsOfOtherNumbersAreRefused) {
  const Folder folder;
  write_floats(folder / "4.bin", turn_of(4));
  EXPECT_EQ(read_bin_cloud(folder / "4.bin").width, 1000U);
  for (const std::size_t numbers : {3U, 5U, 6U}) {
    const std::string file = folder / (std::to_string(numbers) + ".bin");
    write_floats(file, turn_of(numbers));
    EXPECT_NE(input_error([&] {
                (void)read_bin_cloud(file);
              }).find("its points seem to be of " + std::to_string(numbers) + " float32 each"),
              std::string::npos)
        << numbers;
  }
  std::vector<float> by_axis;
  const std::vector<float> points = turn_of(4);
  for (std::size_t axis = 0; axis < 4; ++axis)
    for (std::size_t i = axis; i < points.size(); i += 4) by_axis.push_back(points[i]);
  const std::string file = folder / "axes.bin";
  write_floats(file, by_axis);
  EXPECT_NE(input_error([&] { (void)read_bin_cloud(file); }).find("all x, then all y"), std::string::npos);
}

TEST(BinCloud, PointsMayComeInAnyOrder) {
  const Folder folder;
  std::vector<float> as_fired, mixed;
  for (int i = 0; i < 4000; ++i) {
    const int laser = i % 16, k = i * 1223 % 4000;  // 4000 and 1223 have no common factor
    const float up = 0.0349F * static_cast<float>(laser % 2 == 0 ? laser / 2 - 7 : laser / 2 + 1);
    const float angle = 0.00157F * static_cast<float>(i), other = 0.00157F * static_cast<float>(k);
    as_fired.insert(as_fired.end(), {9 * std::cos(angle), 6 * std::sin(angle), 8 * std::sin(up), 0.3F});
    mixed.insert(mixed.end(), {9 * std::cos(other), 6 * std::sin(other), static_cast<float>(k % 16) * 0.2F, 0.5F});
  }
  for (const auto& [name, points] : {std::pair("fired.bin", as_fired), std::pair("mixed.bin", mixed)}) {
    write_floats(folder / name, points);
    EXPECT_EQ(read_bin_cloud(folder / name).width, 4000U) << name;
  }
}

TEST(BinCloud, WhatCannotBePointsIsRefusedByName) {
  const Folder folder;
  const std::string file = folder / "0.bin";
  const auto complaint = [&](const std::string& bytes) {
    write_raw(file, bytes);
    const std::string said = input_error([&] { (void)read_bin_cloud(file); });
    EXPECT_EQ(said.find(file), 0U) << said;
    return said;
  };
  EXPECT_NE(complaint("").find("is empty"), std::string::npos);
  EXPECT_NE(complaint(std::string(20, '\0')).find("20 bytes are no whole points"), std::string::npos);
  EXPECT_NE(complaint(std::string(160, 'x')).find("no coordinates in metres"), std::string::npos);
  std::filesystem::resize_file(file, std::uintmax_t{1} << 40U);  // a hole
  EXPECT_NE(input_error([&] { (void)read_bin_cloud(file); }).find("at most 64000000"), std::string::npos);
}

}  // namespace
}  // namespace plumbline::slam
