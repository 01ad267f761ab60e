// SPDX-License-Identifier: Apache-2.0
#include "scenarios/metrics/segmentation_score.h"

#include <gtest/gtest.h>

#include "tests/scenarios/metrics/straight_walk.h"

namespace plumbline::scenarios::score {
namespace {

/// Two walls at right angles, x = 2 and y = 2, from -2 to 2 and 0 to 3 m high, seen from the origin; the first of two
/// elements side by side.
bim::BuildingMesh corner() {
  bim::BuildingMesh mesh;
  const auto wall = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    const auto k = static_cast<int>(mesh.vertices.size());
    const Eigen::Vector3d up(0, 0, 3);
    for (const Eigen::Vector3d& v : {a, b, Eigen::Vector3d(b + up), Eigen::Vector3d(a + up)})
      mesh.vertices.push_back(v);
    mesh.triangles.emplace_back(k, k + 1, k + 2);
    mesh.triangles.emplace_back(k, k + 2, k + 3);
  };
  wall({2, 2, 0}, {2, 0, 0});
  wall({2, 0, 0}, {2, -2, 0});
  wall({-2, 2, 0}, {2, 2, 0});
  return mesh;
}

class Segmentation : public testing::Test {
 protected:
  Segmentation() : mesh_(corner()), distance_(mesh_, 0.5) {}

  [[nodiscard]] SegmentationScore score(const slam::SegmentedScan& scan) const {
    return score_segmentation({scan}, straight_walk(2, {0, 0, 0}, 0.0), mesh_, distance_);
  }

  const bim::BuildingMesh mesh_;
  const SurfaceDistance distance_;
};

/// n returns on the wall x = 2 (or y = 2) from -1.8 to 1.6 m along it.
void add(slam::SegmentedScan& scan, bool on_x, int n, int plane, int off_mm = 0) {
  for (int i = 0; i < n; ++i) {
    const int along = -1800 + 3400 * i / n;
    const int across = 2000 + off_mm;
    scan.point_mm.emplace_back(on_x ? across : along, on_x ? along : across, 1000);
    scan.plane.push_back(plane);
  }
}

TEST_F(Segmentation, LabelsAreSurfacesNotElements) {
  SurfaceLabels labels(mesh_, distance_, {});
  const Eigen::Vector3d from(0, 0, 1);
  const int x_wall = labels.of({2.02, -1.0, 1.0}, from), y_wall = labels.of({-1.0, 1.97, 1.0}, from);
  EXPECT_GE(x_wall, 0);
  EXPECT_EQ(labels.of({2.0, 1.0, 1.0}, from), x_wall);
  EXPECT_NE(x_wall, y_wall);
  EXPECT_EQ(labels.of({1.99, 1.98, 1.0}, from), -1);           // in the corner
  EXPECT_EQ(labels.of({1.5, 0.0, 1.0}, from), -1);             // on nothing
  EXPECT_EQ(labels.of({2.0, 0.0, 1.0}, {4.0, 0.0, 1.0}), -1);  // from behind
}

TEST_F(Segmentation, RightPlanesScoreOne) {
  slam::SegmentedScan scan{0, {0, 0, 0}, {}, {}};
  add(scan, true, 40, 0, 20);
  add(scan, false, 60, 1, -30);
  const SegmentationScore s = score(scan);
  EXPECT_EQ(s.planes, 2);
  EXPECT_EQ(s.surfaces, 2);
  EXPECT_EQ(*s.precision, 1.0);
  EXPECT_EQ(*s.recall, 1.0);
  EXPECT_EQ(*s.planes_per_surface, 1.0);
}

TEST_F(Segmentation, SplitMergedAndMissed) {
  slam::SegmentedScan scan{0, {0, 0, 0}, {}, {}};
  add(scan, true, 40, 0);  // one wall in two planes, and a tenth of it in none
  add(scan, true, 50, 1);
  add(scan, true, 10, -1);
  const SegmentationScore split = score(scan);
  EXPECT_EQ(*split.precision, 1.0);
  EXPECT_EQ(*split.recall, 0.9);
  EXPECT_EQ(*split.planes_per_surface, 2.0);

  scan = {0, {0, 0, 0}, {}, {}};
  add(scan, true, 60, 0);  // one plane over two walls
  add(scan, false, 40, 0);
  const SegmentationScore merged = score(scan);
  EXPECT_EQ(*merged.precision, 0.0);
  EXPECT_EQ(*merged.recall, 0.6);
  EXPECT_EQ(*merged.planes_per_surface, 1.0);

  scan = {0, {0, 0, 0}, {}, {}};
  add(scan, true, 60, -1);
  const SegmentationScore missed = score(scan);
  EXPECT_FALSE(missed.precision.has_value());
  EXPECT_EQ(*missed.recall, 0.0);
  EXPECT_FALSE(missed.planes_per_surface.has_value());
}

}  // namespace
}  // namespace plumbline::scenarios::score
