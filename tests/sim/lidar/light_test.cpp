// SPDX-License-Identifier: Apache-2.0
#include "sim/lidar/light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/lidar/echo.h"
#include "tests/bim/rays/box_mesh.h"

namespace plumbline::sim {
namespace {

/// A wall at x = 5 behind a body between x = 2 and x = 2.024, which has the surface under test.
class LightTest : public ::testing::Test {
 protected:
  LightTest() {
    bim::add_box(mesh_, {2.0, -20, -20}, {2.024, 20, 20});
    bim::add_box(mesh_, {5.0, -20, -20}, {5.2, 20, 20});
    bim::add_box(mesh_, {-3.2, -20, -20}, {-3.0, 20, 20});
  }

  /// What comes back of one ray from the origin.
  std::vector<Reflection> back(const Eigen::Vector3d& direction, const Surface& body) {
    const bim::RayScene scene(mesh_);
    const std::vector<Surface> surfaces = {body, wall_, wall_};
    Light light(scene, surfaces, config_);
    RaySegment segment;
    segment.ray = {Eigen::Vector3d::Zero(), direction.normalized()};
    std::vector<RaySegment> segments = {segment};
    std::vector<bim::Hit> hits = {scene.cast(segment.ray, 100.0)};
    std::vector<Reflection> out;
    light.trace(segments, hits, out);
    return out;
  }

  bim::BuildingMesh mesh_;
  Surface wall_{0.6, 0.0, 0.0};
  LidarConfig config_;
  Eigen::Vector3d oblique_{1.0, 0.5, 0.1};
};

TEST_F(LightTest, APlainSurfaceStopsTheLight) {
  const auto out = back(oblique_, {0.3, 0.0, 0.0});
  ASSERT_EQ(out.size(), 1U);
  EXPECT_EQ(out[0].element, 0);
  EXPECT_DOUBLE_EQ(out[0].strength, 0.3);
  EXPECT_NEAR(out[0].path_m, 2.0 * oblique_.norm(), 1e-9);
  EXPECT_NEAR(out[0].cosine, 1.0 / oblique_.norm(), 1e-12);
  EXPECT_EQ(out[0].flags, 0);
}

TEST_F(LightTest, APaneLetsLightThroughTwice) {
  const auto out = back(oblique_, {0.01, 0.8, 0.0});
  ASSERT_EQ(out.size(), 2U);
  EXPECT_EQ(out[1].element, 1);
  EXPECT_NEAR(out[1].strength, 0.6 * 0.8 * 0.8, 1e-12);  // once on the way out, once on the way back
  EXPECT_NEAR(out[1].path_m, 5.0 * oblique_.norm(), 1e-9);
  EXPECT_NEAR((out[1].point_W - 5.0 * oblique_).norm(), 0.0, 1e-9);
  EXPECT_EQ(out[1].flags, light_path::through);
}

TEST_F(LightTest, AMirrorShowsWhatIsBehindTheSensor) {
  const auto out = back(oblique_, {0.03, 0.0, 0.9});
  ASSERT_EQ(out.size(), 2U);
  EXPECT_EQ(out[1].element, 2);  // the wall at x = -3: two metres to the mirror, five back
  EXPECT_NEAR(out[1].path_m, 7.0 * oblique_.norm(), 1e-6);
  EXPECT_NEAR(out[1].strength, 0.6 * 0.9 * 0.9, 1e-12);
  EXPECT_NEAR(out[1].point_W.x(), -3.0, 1e-6);
  EXPECT_EQ(out[1].flags, light_path::mirrored);
}

TEST_F(LightTest, PolishedSurfacesGlintWhenTheyFaceTheSensor) {
  const Surface polished{0.03, 0.0, 0.9};
  const auto glints = [&](const Eigen::Vector3d& direction) {
    const auto out = back(direction, polished);
    return std::count_if(out.begin(), out.end(), [](const Reflection& r) { return r.flags & light_path::glint; });
  };
  EXPECT_EQ(glints({1.0, 0.0, 0.0}), 1);
  EXPECT_EQ(glints({1.0, 0.9 * config_.glint_rad, 0.0}), 1);
  EXPECT_EQ(glints({1.0, 1.1 * config_.glint_rad, 0.0}), 0);
}

TEST_F(LightTest, LightBetweenTwoMirrorsComesToAnEnd) {
  const bim::RayScene scene(mesh_);
  const std::vector<Surface> surfaces(3, Surface{0.03, 0.0, 1.0});
  Light light(scene, surfaces, config_);
  RaySegment segment;
  segment.ray = {Eigen::Vector3d::Zero(), Eigen::Vector3d(1.0, 0.01, 0.0).normalized()};
  std::vector<RaySegment> segments = {segment};
  std::vector<bim::Hit> hits = {scene.cast(segment.ray, 100.0)};
  std::vector<Reflection> out;
  light.trace(segments, hits, out);
  const auto plain =
      std::count_if(out.begin(), out.end(), [](const auto& r) { return !(r.flags & light_path::glint); });
  EXPECT_EQ(plain, 3);  // the first mirror, and one after each of two bounces
}

TEST_F(LightTest, WithoutOpticsEverySurfaceIsPlain) {
  config_.optics = false;
  EXPECT_EQ(back(oblique_, {0.05, 0.8, 0.1}).size(), 1U);
}

Reflection at(double path_m, double strength, int element) {
  Reflection r;
  r.path_m = path_m;
  r.strength = strength;
  r.element = element;
  return r;
}

TEST(Echoes, CloseSurfacesGiveOneRangeBetweenThem) {
  std::vector<Reflection> in = {at(4.5, 0.25, 1), at(4.0, 0.25, 0)};
  std::vector<Echo> echoes;
  find_echoes(in, 1.0, echoes);
  ASSERT_EQ(echoes.size(), 1U);
  EXPECT_GT(echoes[0].range_m, 4.0);
  EXPECT_LT(echoes[0].range_m, 4.25);  // nearer to the near one, whose light is less spread
  EXPECT_DOUBLE_EQ(echoes[0].strength, 0.5);
  EXPECT_EQ(echoes[0].main.element, 0);
  EXPECT_EQ(echoes[0].main.flags, light_path::mixed);
}

TEST(Echoes, SurfacesApartGiveOneEach) {
  std::vector<Reflection> in = {at(6.5, 0.1, 3), at(4.0, 0.2, 0), at(5.2, 0.3, 1), at(4.01, 0.2, 0)};
  std::vector<Echo> echoes;
  find_echoes(in, 1.0, echoes);
  ASSERT_EQ(echoes.size(), 3U);
  EXPECT_EQ(echoes[0].main.element, 0);
  EXPECT_EQ(echoes[0].main.flags, 0);  // one centimetre apart is one surface
  EXPECT_NEAR(echoes[0].range_m, 4.005, 1e-4);
  EXPECT_DOUBLE_EQ(echoes[1].range_m, 5.2);
  EXPECT_DOUBLE_EQ(echoes[2].range_m, 6.5);
  find_echoes({}, 1.0, echoes);
  EXPECT_TRUE(echoes.empty());
}

}  // namespace
}  // namespace plumbline::sim
