// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/terrain_noise.h"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <set>

namespace plumbline::sim {
namespace {

constexpr double height_m = 0.02;

ModelConfig with_plates() {
  ModelConfig config;
  config.plates = TerrainNoiseConfig().plates();
  return config;
}

struct Fixture {
  ModelPtr model = load_model(model_xml(with_plates()));
  std::vector<int> geoms = plate_geoms(*model, with_plates().plates);

  [[nodiscard]] TerrainNoise noise(std::uint64_t seed = 1) const { return {height_m, {0.0, 0.0}, geoms, seed}; }
  /// Places of the plates that are in the model.
  [[nodiscard]] std::set<std::array<double, 3>> places() const {
    std::set<std::array<double, 3>> out;
    for (const int geom : geoms) {
      const double* p = model->geom_pos + std::ptrdiff_t{3} * geom;
      if (p[2] > -10.0) out.insert({p[0], p[1], p[2]});
    }
    return out;
  }
};

TEST(TerrainNoise, NoCornerIsHigherThanAskedForAndNoPlateLiesAtTheStart) {
  const Fixture fixture;
  const TerrainNoise noise = fixture.noise();
  double highest = 0.0;
  int plates = 0;
  for (int i = -30; i < 30; ++i)
    for (int j = -30; j < 30; ++j) {
      const std::optional<CollisionBox> box = noise.plate({i, j});
      if (!box) continue;
      ++plates;
      EXPECT_GE(box->X_WB.t.head<2>().norm(), TerrainNoiseConfig().start_clear_m);
      const double top = box->X_WB.t.z() + (box->X_WB.rotation().cwiseAbs() * box->half).z();
      EXPECT_LE(top, height_m + 1e-12);
      EXPECT_GE(top, 0.0 - 1e-3);
      highest = std::max(highest, top);
    }
  EXPECT_GT(plates, 3500);
  EXPECT_GT(highest, 0.9 * height_m);
}

/// What lies in reach does not depend on the way there.
TEST(TerrainNoise, ThePlatesAroundAPlaceAreTheSameFromEverySide) {
  const Fixture one;
  TerrainNoise there = one.noise();
  there.refresh(*one.model, {5.05, -3.05}, 0.0);
  const Fixture other;
  TerrainNoise walked = other.noise();
  for (int i = 0; i <= 100; ++i) walked.refresh(*other.model, {0.0505 * i, -0.0305 * i}, 0.0);
  EXPECT_EQ(one.places(), other.places());
  EXPECT_EQ(one.places().size(), static_cast<std::size_t>(TerrainNoiseConfig().plates()));
  const Fixture third;
  TerrainNoise seed_2 = third.noise(2);
  seed_2.refresh(*third.model, {5.05, -3.05}, 0.0);
  EXPECT_NE(third.places(), one.places());
}

TEST(TerrainNoise, PlatesLieOnTheFloorOfTheStorey) {
  const Fixture fixture;
  TerrainNoise noise = fixture.noise();
  noise.refresh(*fixture.model, {5.0, 5.0}, 0.0);
  const auto below = fixture.places();
  noise.refresh(*fixture.model, {5.0, 5.0}, 3.0);
  const auto above = fixture.places();
  ASSERT_EQ(below.size(), above.size());
  for (const auto& [x, y, z] : below) EXPECT_TRUE(above.contains({x, y, z + 3.0}));
}

}  // namespace
}  // namespace plumbline::sim
