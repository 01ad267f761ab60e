// SPDX-License-Identifier: Apache-2.0
#include "scenarios/localizability/element_evidence.h"

#include <gtest/gtest.h>

#include <array>

namespace plumbline::scenarios {
namespace {

constexpr double away_m = 1000.0;  ///< the other place, out of sight

/// Upright squares of 10 m across the x axis, an element each.
bim::BuildingMesh walls_at(const std::vector<double>& xs) {
  bim::BuildingMesh mesh;
  for (const double x : xs) {
    const int first = static_cast<int>(mesh.vertices.size()), element = static_cast<int>(mesh.elements.size());
    for (const auto& [y, z] : {std::pair(-5.0, 0.0), std::pair(5.0, 0.0), std::pair(5.0, 3.0), std::pair(-5.0, 3.0)})
      mesh.vertices.emplace_back(x, y, z);
    mesh.triangles.emplace_back(first, first + 1, first + 2);
    mesh.triangles.emplace_back(first, first + 2, first + 3);
    mesh.element.insert(mesh.element.end(), 2, element);
    mesh.elements.emplace_back();
  }
  return mesh;
}

// A row of cupboards 0.6 m before the wall ahead, where the other place has its wall.
TEST(ElementEvidence, FurnitureWhereTheOtherPoseHasAWallIsOneCoincidence) {
  const RangeImager imager;
  const bim::RayScene planned(walls_at({5.0, away_m + 4.4})), built(walls_at({4.4, 5.0, away_m + 4.4}));
  const std::array<char, 3> loose = {1, 0, 0};
  const SensorPose truth{{0.0, 0.0, 1.0}, 0.0}, other{{away_m, 0.0, 1.0}, 0.0};
  const ComparedScenes scenes{&planned, &built, loose};
  const SeenPlace place = see(imager, scenes, truth);
  ElementEvidence evidence;
  for (int scan = 0; scan < 20; ++scan) evidence.add(imager, scenes, place, other);
  EXPECT_LT(evidence.by_furniture, -localizability_constants.drop_llr) << "without the cap";
  EXPECT_NEAR(evidence.llr, -localizability_constants.marginal_llr, 1e-9);
  // The cupboards gone, the wall behind them is seen, which no longer has to make up for twenty scans.
  const ComparedScenes empty{&planned, &planned, {}};
  const SeenPlace bare = see(imager, empty, truth);
  int scans = 0;
  while (evidence.llr <= localizability_constants.drop_llr && scans < 10) {
    evidence.add(imager, empty, bare, other);
    ++scans;
  }
  EXPECT_LE(scans, 3);
}

}  // namespace
}  // namespace plumbline::scenarios
