// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/replay/map_packer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace plumbline::scenarios {
namespace {

Eigen::Vector3d point_of(const PackedMap& map, std::size_t i) {
  Eigen::Vector3d p;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t at = axis * map.count + i;
    const auto low = static_cast<std::uint8_t>(map.bytes[at]),
               high = static_cast<std::uint8_t>(map.bytes[3 * map.count + at]);
    p[static_cast<Eigen::Index>(axis)] = 0.01 * static_cast<std::int16_t>(low | high << 8);
  }
  return p;
}

TEST(MapPacker, KeepsPointsWhereTheyAreToACentimetre) {
  const Pose X = Pose::from_xyz_yaw({1000.0, -5.0, 3.0}, 0.5 * std::numbers::pi);
  const std::vector<Eigen::Vector3f> map = {{1.0F, 2.0F, 0.5F}, {4.04F, 0.04F, -1.04F}, {4.05F, 0.05F, -1.05F}};
  const PackedMap packed = pack_map(map, X, {1000.0, 0.0, 0.0});
  ASSERT_EQ(packed.count, 2U);  // two of them share a voxel
  EXPECT_LT((point_of(packed, 0) - Eigen::Vector3d(-0.04, -0.96, 1.96)).norm(), 0.01);
  EXPECT_LT((point_of(packed, 1) - Eigen::Vector3d(-2.0, -4.0, 3.5)).norm(), 0.01);
}

// Every fifth of a million points.
TEST(MapPacker, ReadsEverySoManyOfALargeMap) {
  std::vector<Eigen::Vector3f> map(1'000'000, Eigen::Vector3f(1.0F, 0.0F, 0.0F));
  for (std::size_t i = 0; i < map.size(); ++i)
    if (i % 5 != 0) map[i].x() = 2.0F;
  const PackedMap packed = pack_map(map, Pose(), Eigen::Vector3d::Zero());
  ASSERT_EQ(packed.count, 1U);
  EXPECT_NEAR(point_of(packed, 0).x(), 1.0, 0.01);
}

TEST(MapPacker, ThinsUntilThereAreFewEnough) {
  std::vector<Eigen::Vector3f> map;
  const auto spread = [](int i, double step, double size) {
    return static_cast<float>(size * std::fmod(step * i, 1.0));
  };
  for (int i = 0; i < 20000; ++i)
    map.emplace_back(spread(i, 0.7548776662, 20.0), spread(i, 0.5698402910, 20.0), spread(i, 0.3819660113, 3.0));
  map.emplace_back(1e6F, 0.0F, 0.0F);  // beyond what 16 bits hold
  const PackedMap packed = pack_map(map, Pose(), Eigen::Vector3d::Zero(), 1000);
  EXPECT_LE(packed.count, 1000U);
  EXPECT_GE(packed.count, 300U);
  EXPECT_EQ(packed.bytes.size(), 6 * packed.count);
  for (std::size_t i = 0; i < packed.count; ++i) EXPECT_LT(point_of(packed, i).maxCoeff(), 20.01);
}

}  // namespace
}  // namespace plumbline::scenarios
