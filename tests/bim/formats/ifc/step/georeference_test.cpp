// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/georeference.h"

#include <gtest/gtest.h>

#include <limits>

namespace plumbline::bim {
namespace {

StepProduct wall_at(const Eigen::Vector3d& at) {
  StepProduct wall;
  wall.kind = StepClass::wall;
  wall.X_WP.translation() = at;
  wall.axis_W = {at, at + Eigen::Vector3d(4, 0, 0)};
  Shape shape;
  shape.base.points = {{0, 0, 0}, {4, 0, 0}, {4, 0.2, 3}};
  wall.body = {shape};
  return wall;
}

TEST(Recentre, MovesMapCoordinatesByWholeMetres) {
  StepModel model;
  const Eigen::Vector3d corner(512345.678, 5412345.25, 312.5);
  for (const double x : {0.0, 3.0, 8.0}) model.products.push_back(wall_at(corner + Eigen::Vector3d(x, 0, 0)));
  StepProduct far;  // not a wall: moves with the others but has no say
  far.kind = StepClass::obstacle;
  model.products.push_back(far);
  const std::optional<Eigen::Vector3d> move = move_to_origin(model);
  ASSERT_TRUE(move.has_value());
  EXPECT_EQ(*move, Eigen::Vector3d(-512349, -5412345, 0));  // the middle wall's x rounded; heights are near enough
  EXPECT_EQ(model.products[1].X_WP.translation(), corner + Eigen::Vector3d(3, 0, 0) + *move);
  EXPECT_EQ(model.products[1].axis_W.front(), model.products[1].X_WP.translation());
  EXPECT_EQ(model.products[3].X_WP.translation(), *move);
  EXPECT_FALSE(move_to_origin(model).has_value());
}

TEST(Recentre, OneStrayWallMovesNothing) {
  StepModel model;
  for (const double x : {0.0, 3.0, 8.0, 4e6}) model.products.push_back(wall_at({x, 1, 0}));
  EXPECT_FALSE(move_to_origin(model).has_value());
  EXPECT_EQ(model.products.front().X_WP.translation(), Eigen::Vector3d(0, 1, 0));
}

TEST(Recentre, HeightsMoveApart) {
  StepModel model;
  model.products.push_back(wall_at({1, 2, 8000.4}));
  const std::optional<Eigen::Vector3d> move = move_to_origin(model);
  ASSERT_TRUE(move.has_value());
  EXPECT_EQ(*move, Eigen::Vector3d(0, 0, -8000));
}

TEST(Recentre, WithoutWallsGoesByWhatElseStandsThere) {
  for (const StepClass kind : {StepClass::slab, StepClass::column, StepClass::space}) {
    StepModel model;
    for (const double x : {0.0, 3.0, 8.0}) {
      model.products.push_back(wall_at({5.2e6 + x, 1, 0}));
      model.products.back().kind = kind;
    }
    for (int i = 0; i < 9; ++i) {
      model.products.push_back(wall_at({0, 0, 0}));
      model.products.back().kind = StepClass::obstacle;
    }
    const std::optional<Eigen::Vector3d> move = move_to_origin(model);
    ASSERT_TRUE(move.has_value());
    EXPECT_EQ(*move, Eigen::Vector3d(-5200003, -1, 0));
  }
  StepModel model;  // nothing but other elements
  model.products.push_back(wall_at({5.2e6, 1, 0}));
  model.products.back().kind = StepClass::obstacle;
  EXPECT_TRUE(move_to_origin(model).has_value());
}

TEST(Recentre, NeedsABody) {
  StepModel model;
  EXPECT_FALSE(move_to_origin(model).has_value());
}

TEST(WithinReach, BoundsPlacesAndSizes) {
  EXPECT_TRUE(within_reach(wall_at({9e6, -9e6, 0})));
  EXPECT_TRUE(within_reach(wall_at({32.5e6, 5.8e6, 0}))) << "EPSG:4647";
  EXPECT_TRUE(within_reach(wall_at({38.5e6, 3.4e6, 0}))) << "CGCS2000, zone 38";
  EXPECT_FALSE(within_reach(wall_at({2e8, 0, 0})));
  StepProduct large = wall_at({0, 0, 0});
  large.body.front().base.points.emplace_back(2e4, 0, 0);
  EXPECT_FALSE(within_reach(large));
  StepProduct odd = wall_at({0, 0, 0});
  odd.body.front().base.points.front().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(within_reach(odd));
  EXPECT_FALSE(is_finite(odd)) << "it is not said to be too large";
  EXPECT_TRUE(is_finite(large));
}

}  // namespace
}  // namespace plumbline::bim
