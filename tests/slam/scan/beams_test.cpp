// SPDX-License-Identifier: Apache-2.0
#include "slam/scan/beams.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

/// Of so many beams, equally far apart, each so often.
std::vector<double> elevations(double from_deg, double to_deg, int beams, int times) {
  std::vector<double> result;
  for (int k = 0; k < beams * times; ++k)
    result.push_back(degree * (from_deg + (to_deg - from_deg) * (k % beams) / (beams - 1)));
  return result;
}

TEST(BeamsTest, RingsCountFromTheLowest) {
  for (int k = 0; k < 16; ++k) EXPECT_EQ(ring_of(Beams::vlp16, degree * (-15.0 + 2.0 * k + 0.9)), k);
  for (int k = 0; k < 32; ++k) EXPECT_EQ(ring_of(Beams::hdl32, degree * (-30.67 + 4.0 / 3.0 * k - 0.6)), k);
  for (int k = 0; k < 32; ++k) EXPECT_EQ(ring_of(Beams::hdl64, degree * (-24.33 + 0.5 * k)), k);
  for (int k = 0; k < 32; ++k) EXPECT_EQ(ring_of(Beams::hdl64, degree * (-8.33 + k / 3.0)), 32 + k);
  EXPECT_EQ(ring_of(Beams::vlp16, 16.1 * degree), -1);
  EXPECT_EQ(ring_of(Beams::vlp16, -16.1 * degree), -1);
  EXPECT_EQ(ring_of(Beams::hdl64, 2.2 * degree), -1);
  EXPECT_EQ(ring_of(Beams::hdl64, -24.6 * degree), -1);
  EXPECT_EQ(ring_of(Beams::none, 0.0), -1);
}

TEST(BeamsTest, ElevationsTellTheLidar) {
  EXPECT_EQ(beams_of(elevations(-15.0, 15.0, 16, 100)), Beams::vlp16);
  EXPECT_EQ(beams_of(elevations(-30.67, 10.67, 32, 100)), Beams::hdl32);
  EXPECT_EQ(beams_of(elevations(-24.9, 2.0, 64, 100)), Beams::hdl64);
  EXPECT_EQ(beams_of(elevations(-16.6, 16.6, 64, 100)), Beams::none) << "an OS1-64";
  EXPECT_EQ(beams_of(elevations(-38.0, 38.0, 1000, 10)), Beams::none) << "a solid-state LiDAR";
  EXPECT_EQ(beams_of(elevations(-15.0, 15.0, 16, 10)), Beams::none) << "too few";
}

Scan room_scan() {
  return synthetic::standing_scan(synthetic::one_room(), Pose::from_xyz_yaw({2.0, 1.5, 0.5}, 0.3), {});
}

TEST(BeamsTest, RingsComeBackAndGoRound) {
  const Scan scan = room_scan();
  const DeskewedScan flat = as_deskewed(synthetic::without_rings(scan), synthetic::calibration());
  const std::optional<DeskewedScan> sorted = BeamsOfRecording(Beams::automatic).in_rings(flat);
  ASSERT_TRUE(sorted.has_value());
  ASSERT_EQ(sorted->rings, scan.rings);
  for (int ring = 0; ring < scan.rings; ++ring) {
    int before = 0, after = 0;
    for (int column = 0; column < scan.columns; ++column)
      before += scan.range_m[static_cast<std::size_t>(column * scan.rings + ring)] > 0.0;
    double last = std::numeric_limits<double>::infinity();
    for (int column = 0; column < sorted->columns; ++column) {
      const auto i = static_cast<std::size_t>(column * scan.rings + ring);
      if (!(sorted->range_m[i] > 0.0)) continue;
      ++after;
      const Eigen::Vector3d p_L = sorted->X_RL.inverse() * sorted->point_R[i];
      EXPECT_NEAR(elevation(p_L), degree * (-15.0 + 2.0 * ring), 0.1 * degree);
      const double azimuth = std::atan2(p_L.y(), p_L.x());
      EXPECT_LE(azimuth, last);
      last = azimuth;
    }
    EXPECT_EQ(after, before);
  }
}

TEST(BeamsTest, ScansWithRingsAreLeftAlone) {
  const Scan scan = room_scan();
  BeamsOfRecording beams(Beams::vlp16);
  EXPECT_EQ(beams.of(scan), Beams::none);
  EXPECT_FALSE(beams.in_rings(as_deskewed(scan, synthetic::calibration())).has_value());
  EXPECT_EQ(beams.of(synthetic::without_rings(scan)), Beams::vlp16);
}

TEST(BeamsTest, OneScanTellsForTheRecording) {
  const Scan scan = synthetic::without_rings(room_scan());
  Scan empty;
  empty.rings = 1;
  BeamsOfRecording beams(Beams::automatic);
  EXPECT_EQ(beams.of(empty), Beams::none);
  EXPECT_EQ(beams.of(scan), Beams::vlp16);
  EXPECT_EQ(beams.of(empty), Beams::vlp16);
}

TEST(BeamsTest, LowRingsMayBeLeftOut) {
  const Scan scan = synthetic::without_rings(room_scan());
  const std::optional<DeskewedScan> sorted =
      BeamsOfRecording(Beams::hdl64, 13).in_rings(as_deskewed(scan, synthetic::calibration()));
  ASSERT_TRUE(sorted.has_value());
  for (std::size_t i = 0; i < sorted->range_m.size(); ++i)
    if (i % 64 < 13) {
      EXPECT_EQ(sorted->range_m[i], 0.0);
    }
}

}  // namespace
}  // namespace plumbline::slam
