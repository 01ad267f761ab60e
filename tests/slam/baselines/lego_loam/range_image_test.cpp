// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/lego_loam/range_image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/slam/synthetic.h"

namespace plumbline::slam::lego {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

/// An image of cells with these ranges at level rows 2 degrees apart; 0: empty.
RangeImage image_of(int rows, int columns, const std::vector<double>& ranges) {
  RangeImage image{rows, columns, {}};
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    ImagePoint point;
    point.range_m = ranges[i];
    point.row = static_cast<int>(i) / columns;
    point.column = static_cast<int>(i) % columns;
    if (ranges[i] > 0.0) point.cell = Cell::open;
    image.cells.push_back(point);
  }
  return image;
}

TEST(LegoGround, IsTheFloorAndOnlyThat) {
  const synthetic::WalkConfig quiet{.range_sigma_m = 0.0, .dropout = 0.0, .vibration = 0.0};
  const Scan scan =
      synthetic::standing_scan(synthetic::one_room(12.0, 10.0), Pose::from_xyz_yaw({6.0, 5.0, 0.46}, 0.0), quiet);
  RangeImageConfig config;
  RangeImage image = range_image(scan, synthetic::calibration().X_RL, config);
  mark_ground(image, config);
  const double floor_z = -synthetic::calibration().sensor_height_m;
  int ground = 0, wrong = 0, floor = 0;
  for (const ImagePoint& point : image.cells) {
    const bool low = point.cell != Cell::empty && std::abs(point.p_L.z() - floor_z) < 0.01;
    floor += low;
    ground += point.cell == Cell::ground;
    // Nothing checks heights: the lowest return of a wall may lie level with the last one of the floor.
    const bool above_floor = point.row > 0 && std::abs(image.at(point.row - 1, point.column).p_L.z() - floor_z) < 0.01;
    wrong += point.cell == Cell::ground && !low && !above_floor;
  }
  EXPECT_GT(ground, 0.95 * floor);
  EXPECT_EQ(wrong, 0);
}

TEST(LegoGround, ASlopeOfMoreThanTenDegreesIsNone) {
  for (const auto& [degrees, expected] : {std::pair(9.5, Cell::ground), std::pair(10.5, Cell::open)}) {
    RangeImage image = image_of(16, 1, std::vector<double>(16, 5.0));
    for (int row = 0; row < 16; ++row) image.at(row, 0).p_L = {0.5 * row, 0.0, 0.5 * row * std::tan(degrees * degree)};
    mark_ground(image, {});
    EXPECT_EQ(image.at(0, 0).cell, expected) << degrees;
    EXPECT_EQ(image.at(15, 0).cell, Cell::open);  // above the rows that may show it
  }
}

// The line between two neighbours must make more than 60 degrees with the farther one's beam.
TEST(LegoSegments, JoinByTheAngleBetweenBeamAndSurface) {
  for (const double alpha : {0.2 * degree, 2.0 * degree}) {
    // Range of the second beam where that line makes an angle of b at the first point, of range 5 m.
    const auto second = [&](double b) { return 5.0 * std::sin(b) / std::sin(b + alpha); };
    EXPECT_TRUE(joined(5.0, second(61.0 * degree), alpha, {}));
    EXPECT_FALSE(joined(5.0, second(59.0 * degree), alpha, {}));
    EXPECT_TRUE(joined(second(61.0 * degree), 5.0, alpha, {}));
  }
}

TEST(LegoSegments, SmallOnesNeedRows) {
  RangeImageConfig config;
  // A pole two cells wide on three rows; the seed's row counts, since its other cell is joined.
  RangeImage pole = image_of(4, 10, std::vector<double>(40, 0.0));
  for (int row = 0; row < 3; ++row)
    for (int column = 4; column < 6; ++column) {
      pole.at(row, column).range_m = 4.0;
      pole.at(row, column).cell = Cell::open;
    }
  RangeImage flat = image_of(4, 10, std::vector<double>(40, 0.0));
  for (int row = 0; row < 2; ++row)
    for (int column = 4; column < 7; ++column) {
      flat.at(row, column).range_m = 4.0;
      flat.at(row, column).cell = Cell::open;
    }
  const std::vector<double> angles(3, 2.0 * degree);
  config.columns = 10;
  mark_segments(pole, angles, config);
  mark_segments(flat, angles, config);
  EXPECT_EQ(pole.at(1, 5).cell, Cell::segment);
  EXPECT_EQ(flat.at(1, 5).cell, Cell::clutter);
}

/// A wall all round, seen by so many columns of 16 rings, each fifth return of the third ring missing.
Scan round_wall(int columns, double range_m) {
  Scan scan;
  scan.rings = 16;
  scan.columns = columns;
  for (int column = 0; column < columns; ++column)
    for (int ring = 0; ring < 16; ++ring) {
      const double azimuth = -2.0 * std::numbers::pi * column / columns, elevation = (2.0 * ring - 15.0) * degree;
      const bool missing = ring == 2 && column % 5 == 0;
      scan.range_m.push_back(missing ? 0.0 : range_m);
      scan.point_L.push_back(missing ? Eigen::Vector3d(0, 0, 0)
                                     : Eigen::Vector3d(range_m * std::cos(elevation) * std::cos(azimuth),
                                                       range_m * std::cos(elevation) * std::sin(azimuth),
                                                       range_m * std::sin(elevation)));
      scan.offset_ns.push_back(0);
    }
  return scan;
}

// A LiDAR with another number of columns is seen as whole as a VLP-16: an empty column between two beams parts
// segments.
TEST(LegoImage, HasNoEmptyColumnWhateverTheLidar) {
  for (const auto& [beams, expected] :
       {std::pair(1808, 1800), {1800, 1800}, {904, 900}, {1024, 1000}, {2048, 2000}, {60, 60}}) {
    const Scan scan = round_wall(beams, 4.0);
    EXPECT_EQ(columns_of(scan), expected) << beams;
    const SegmentedCloud cloud = segmented_cloud(scan, Pose(), {});
    EXPECT_EQ(cloud.rows[8].size(), static_cast<std::size_t>(expected)) << beams;
  }
  EXPECT_EQ(columns_of(Scan()), 1800);
}

TEST(LegoSegments, ColumnsWrap) {
  RangeImage ring = image_of(1, 40, std::vector<double>(40, 0.0));
  for (int k = -15; k < 15; ++k) {
    ring.at(0, (k + 40) % 40).range_m = 4.0;
    ring.at(0, (k + 40) % 40).cell = Cell::open;
  }
  mark_segments(ring, {}, {});
  EXPECT_EQ(ring.at(0, 0).cell, Cell::segment);
  EXPECT_EQ(ring.at(0, 39).cell, Cell::segment);
}

}  // namespace
}  // namespace plumbline::slam::lego
