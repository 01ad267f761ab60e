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
  config.plates = UnevenConfig().plates();
  return config;
}

struct Fixture {
  ModelPtr model = load_model(model_xml(with_plates()));
  std::vector<int> geoms = plate_geoms(*model, with_plates().plates);

  [[nodiscard]] Uneven uneven(std::uint64_t seed = 1) const { return {height_m, {0.0, 0.0}, geoms, seed}; }
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

TEST(Uneven, NoCornerIsHigherThanAskedForAndNoPlateLiesAtTheStart) {
  const Fixture fixture;
  const Uneven uneven = fixture.uneven();
  double highest = 0.0;
  int plates = 0;
  for (int i = -30; i < 30; ++i)
    for (int j = -30; j < 30; ++j) {
      const std::optional<CollisionBox> box = uneven.plate({i, j});
      if (!box) continue;
      ++plates;
      EXPECT_GE(box->X_WB.t.head<2>().norm(), UnevenConfig().even_m);
      const double top = box->X_WB.t.z() + (box->X_WB.rotation().cwiseAbs() * box->half).z();
      EXPECT_LE(top, height_m + 1e-12);
      EXPECT_GE(top, 0.0 - 1e-3);
      highest = std::max(highest, top);
    }
  EXPECT_GT(plates, 3500);
  EXPECT_GT(highest, 0.9 * height_m);
}

/// What lies in reach does not depend on the way there.
TEST(Uneven, ThePlatesAroundAPlaceAreTheSameFromEverySide) {
  const Fixture one;
  Uneven there = one.uneven();
  there.refresh(*one.model, {5.05, -3.05}, 0.0);
  const Fixture other;
  Uneven walked = other.uneven();
  for (int i = 0; i <= 100; ++i) walked.refresh(*other.model, {0.0505 * i, -0.0305 * i}, 0.0);
  EXPECT_EQ(one.places(), other.places());
  EXPECT_EQ(one.places().size(), static_cast<std::size_t>(UnevenConfig().plates()));
  const Fixture third;
  Uneven seed_2 = third.uneven(2);
  seed_2.refresh(*third.model, {5.05, -3.05}, 0.0);
  EXPECT_NE(third.places(), one.places());
}

TEST(Uneven, PlatesLieOnTheFloorOfTheStorey) {
  const Fixture fixture;
  Uneven uneven = fixture.uneven();
  uneven.refresh(*fixture.model, {5.0, 5.0}, 0.0);
  const auto below = fixture.places();
  uneven.refresh(*fixture.model, {5.0, 5.0}, 3.0);
  const auto above = fixture.places();
  ASSERT_EQ(below.size(), above.size());
  for (const auto& [x, y, z] : below) EXPECT_TRUE(above.contains({x, y, z + 3.0}));
}

}  // namespace
}  // namespace plumbline::sim
