// SPDX-License-Identifier: Apache-2.0
#include "slam/mapping/wall_faces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/slam/graph/random_values.h"

namespace plumbline::slam {
namespace {

std::vector<WallFace> faces_at_random(RandomValues& random) {
  std::vector<WallFace> faces;
  for (int k = 0; k < 12; ++k) {
    const double yaw = random.uniform(-4.0, 4.0);
    WallFace face;
    face.plane = {{std::cos(yaw), std::sin(yaw), 0.0}, random.uniform(-6.0, 6.0)};
    face.along = Eigen::Vector2d(-std::sin(yaw), std::cos(yaw)) * (k % 2 == 0 ? 1.0 : -1.0);
    face.s0 = random.uniform(-8.0, 4.0);
    face.s1 = face.s0 + random.uniform(0.05, 9.0);
    faces.push_back(face);
  }
  return faces;
}

Eigen::Vector3d point_at_random(RandomValues& random) {
  const double x = random.uniform(-9.0, 9.0), y = random.uniform(-9.0, 9.0), z = random.uniform(0.0, 3.0);
  return {x, y, z};
}

bool between_ends(const WallFace& face, const Eigen::Vector3d& p) {
  const double s = face.along.dot(p.head<2>());
  return s >= face.s0 && s <= face.s1;
}

TEST(FacesNear, LeavesOutNoneWithinReach) {
  int met = 0;
  for (std::uint64_t trial = 0; trial < 40; ++trial) {
    RandomValues random(71, trial);
    const std::vector<WallFace> faces = faces_at_random(random);
    const double reach_m = random.uniform(0.02, 0.6);
    const FacesNear near(faces, reach_m);
    for (int k = 0; k < 300; ++k) {
      const Eigen::Vector3d p = point_at_random(random);
      const auto found = near.of(p);
      EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
      for (std::uint32_t f = 0; f < faces.size(); ++f) {
        if (std::abs(faces[f].plane.distance(p)) > reach_m || !between_ends(faces[f], p)) continue;
        EXPECT_EQ(std::count(found.begin(), found.end(), f), 1) << trial;
        ++met;
      }
    }
  }
  EXPECT_GT(met, 1000);
}

TEST(FacesInView, LeavesOutNoneThatARayGoesThrough) {
  int met = 0;
  for (std::uint64_t trial = 0; trial < 100; ++trial) {
    RandomValues random(72, trial);
    const std::vector<WallFace> faces = faces_at_random(random);
    const Eigen::Vector3d from = point_at_random(random);
    const FacesInView in_view(faces, from);
    for (int k = 0; k < 100; ++k) {
      const Eigen::Vector3d p = point_at_random(random);
      const auto found = in_view.towards(p);
      for (std::uint32_t f = 0; f < faces.size(); ++f) {
        const double here = faces[f].plane.distance(from), there = faces[f].plane.distance(p);
        if (here <= 0.0 || there >= 0.0 || !between_ends(faces[f], from + here / (here - there) * (p - from))) continue;
        const auto is_it = [&](const FacesInView::Face& face) { return face.index == f && face.from_m == here; };
        EXPECT_EQ(std::count_if(found.begin(), found.end(), is_it), 1) << trial;
        ++met;
      }
    }
  }
  EXPECT_GT(met, 1000);
}

}  // namespace
}  // namespace plumbline::slam
