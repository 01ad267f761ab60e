// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/replay/scan_packer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scenarios/report/replay/replay_page.h"

namespace plumbline::scenarios {
namespace {

constexpr std::size_t rings = 16, columns = 1824;

/// A scan of a VLP-16 whose range depends on column and ring, with gaps, as a driver decodes it.
slam::Scan scan(double azimuth0, bool vertical_offsets) {
  const slam::LidarModel& model = slam::lidar_model(slam::LidarModelId::vlp16);
  slam::Scan scan;
  scan.stamp = 5'000'000'000;
  scan.columns = columns;
  scan.range_m.assign(rings * columns, 0.0);
  scan.point_L.assign(rings * columns, Eigen::Vector3d::Zero());
  const double rate = 2.0 * std::numbers::pi * 10.0;
  for (std::size_t c = 0; c < columns; ++c)
    for (const slam::Laser& laser : model.lasers) {
      const auto ring = static_cast<std::size_t>(laser.ring);
      if ((c + ring) % 7 == 0) continue;
      const double range = 2.0 + 1.5 * std::sin(0.01 * static_cast<double>(c)) + 0.3 * static_cast<double>(ring);
      const double azimuth = azimuth0 + rate * (static_cast<double>(c) * 55.296e-6 + slam::seconds(laser.time_ns));
      scan.range_m[c * rings + ring] = range;
      scan.point_L[c * rings + ring] = {range * laser.cosine * std::cos(azimuth),
                                        -range * laser.cosine * std::sin(azimuth),
                                        range * laser.sine + (vertical_offsets ? laser.height_m : 0.0)};
    }
  return scan;
}

/// Units by ring and column, as the page's script decodes them.
std::vector<int> decoded(const ScanPacker& packer, std::size_t i) {
  const std::string bytes = packer.ranges(i);
  const std::size_t n = bytes.size() / 2, kept = n / rings;
  std::vector<int> units(n);
  for (std::size_t k = 0; k < n; ++k) {
    const unsigned low = static_cast<unsigned char>(bytes[k]), high = static_cast<unsigned char>(bytes[n + k]);
    const unsigned folded = low | high << 8U;
    const int difference = static_cast<std::int16_t>(folded >> 1U ^ (0U - (folded & 1U)));
    units[k] = (k % kept == 0 ? 0 : units[k - 1]) + difference;
  }
  return units;
}

TEST(ScanPacker, KeepsRangesToHalfAUnitAndWhereTheyLie) {
  for (const bool offsets : {false, true})
    for (const double azimuth0 : {0.0, 1.0, 3.1}) {
      ScanPacker packer(slam::lidar_model(slam::LidarModelId::vlp16), 600.0, offsets);
      const slam::Scan sent = scan(azimuth0, offsets);
      packer.add(sent);
      const ScanGrid& grid = packer.grid();
      ASSERT_EQ(grid.rings, 16);
      ASSERT_EQ(grid.columns, 456);
      EXPECT_NEAR(std::remainder(packer.scans()[0].azimuth0 - azimuth0, 2.0 * std::numbers::pi), 0.0, 1e-6);
      const std::vector<int> units = decoded(packer, 0);
      double furthest = 0.0;
      for (std::size_t ring = 0, k = 0; ring < rings; ++ring)
        for (std::size_t c = 0; c < 456; ++c, ++k) {
          const std::size_t i = 4 * c * rings + ring;
          EXPECT_LE(std::abs(units[k] * grid.unit_m - sent.range_m[i]), 0.5 * grid.unit_m + 1e-12);
          if (units[k] == 0) continue;
          const double range = units[k] * grid.unit_m;
          const double azimuth =
              packer.scans()[0].azimuth0 + static_cast<double>(c) * grid.turn_rad + grid.azimuth_rad[ring];
          const double flat = range * grid.cosine[ring];
          const Eigen::Vector3d p(flat * std::cos(azimuth), -flat * std::sin(azimuth),
                                  range * grid.sine[ring] + grid.height_m[ring]);
          furthest = std::max(furthest, (p - sent.point_L[i]).norm());
        }
      EXPECT_LE(furthest, 0.5 * grid.unit_m + 1e-4);
    }
}

TEST(ScanPacker, TakesEveryModelAndAnyWidth) {
  for (const slam::LidarModelId id : {slam::LidarModelId::vlp16, slam::LidarModelId::vlp32c, slam::LidarModelId::hdl32e,
                                      slam::LidarModelId::os1_64}) {
    ScanPacker packer(slam::lidar_model(id), 600.0, true);
    EXPECT_LE(packer.grid().rings * packer.grid().columns, 7296);
    slam::Scan empty;
    packer.add(empty);  // a message without a column has no return
    for (const int units : decoded(packer, 0)) EXPECT_EQ(units, 0);
  }
}

std::vector<PackedScan> walk(std::size_t scans, std::size_t bytes) {
  std::vector<PackedScan> list;
  for (std::size_t i = 0; i < scans; ++i)
    list.push_back({static_cast<slam::Nanoseconds>(i) * 100'000'000, 0.0, std::string(bytes, 'x')});
  return list;
}

TEST(KeptScans, AreAllWhereTheyFit) { EXPECT_EQ(kept_scans(walk(100, 6000), {}, 1'000'000).size(), 100U); }

TEST(KeptScans, AreDenseNearWhatIsWorthALook) {
  const std::vector<PackedScan> scans = walk(6000, 6000);
  const std::vector<std::size_t> kept = kept_scans(scans, {300.0}, 12'000'000);
  std::size_t near = 0, bytes = 0;
  for (const std::size_t i : kept) {
    bytes += scans[i].bytes.size() * 4 / 3;
    if (i >= 2980 && i <= 3020) ++near;
  }
  EXPECT_EQ(near, 41U);
  EXPECT_LE(bytes, 12'000'000U);
  EXPECT_GT(bytes, 9'000'000U);
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
}

TEST(KeptScans, EndEvenWhereNothingFits) {
  EXPECT_LE(kept_scans(walk(100, 6000), {1.0, 5.0}, 0).size(), 1U);
  EXPECT_TRUE(kept_scans({}, {}, 0).empty());
}

}  // namespace
}  // namespace plumbline::scenarios
