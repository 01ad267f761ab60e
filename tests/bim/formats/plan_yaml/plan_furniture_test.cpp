// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/plan_yaml/plan_furniture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "bim/config/tree.h"
#include "bim/errors.h"
#include "bim/formats/ifc/read/ifc.h"
#include "bim/formats/ifc/write/write_ifc.h"
#include "bim/formats/plan_yaml/plan_elements.h"
#include "bim/formats/plan_yaml/plan_write.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/mesh/solid.h"
#include "tests/bim/furniture/walkable.h"

namespace plumbline::bim {
namespace {

constexpr std::size_t clutter_shapes = EnumNames<ClutterShape>::names.size();

/// Two rooms on two storeys, the upper a copy with a wall of its own; as built, the door is elsewhere and a box is
/// there.
const std::string house =
    "plan: 1\n"
    "name: house\n"
    "storeys: [{id: g, height_m: 2.8}, {id: u, elevation_m: 3, copy_of: g}]\n"
    "walls:\n"
    "  - {id: s, storey: g, a: [0, 0], b: [10, 0]}\n"
    "  - {id: e, storey: g, a: [10, 0], b: [10, 6]}\n"
    "  - {id: n, storey: g, a: [10, 6], b: [0, 6]}\n"
    "  - {id: w, storey: g, a: [0, 6], b: [0, 0]}\n"
    "  - {id: m, storey: g, a: [5, 0], b: [5, 6]}\n"
    "  - {id: own, storey: u, a: [2, 4], b: [4, 4], thickness_m: 0.1}\n"
    "openings: [{id: d, wall: m, s_m: 1.5}]\n"
    "rooms:\n"
    "  - {id: office, storey: g, polygon: [[0, 0], [5, 0], [5, 6], [0, 6]]}\n"
    "  - {id: store, storey: g, polygon: [[5, 0], [10, 0], [10, 6], [5, 6]]}\n"
    "clutter: [{id: furniture_1, storey: g, shape: bed, at: [8, 1.2], size: [1.6, 2], yaw_deg: 180, height_m: 0.9}]\n"
    "deviations:\n"
    "  - {op: move_opening, opening: d, by_m: 2}\n"
    "  - {op: add_clutter, id: furniture_3, storey: g, shape: pallet, at: [7, 4], size: [1.2, 0.8], height_m: 1}\n";

PlanFile plan() { return plan_entries(read_yaml(house, "house.plan.yaml")); }

FurnishOptions options(double density) {
  FurnishOptions options;
  options.density = density;
  return options;
}

TEST(PlanFurniture, EveryShapeIsReadAndBuilt) {
  for (std::size_t i = 0; i < clutter_shapes; ++i) {
    const std::string name(EnumNames<ClutterShape>::names[i]);
    std::string text = house;
    text.replace(text.find("shape: bed"), 10, "shape: " + name);
    text.replace(text.find("shape: pallet"), 13, "shape: " + name);
    const PlanWithDeviations both = read_plan_with_deviations(text, "house.plan.yaml");
    const Obstacle& piece = both.as_planned.obstacles.front();
    EXPECT_EQ(piece.kind, i < 2 ? name : "furniture");
    EXPECT_TRUE(piece.planned);
    EXPECT_TRUE(is_closed(piece.body)) << name;
    Eigen::Vector3d low = piece.body.vertices.front(), high = low;
    for (const Eigen::Vector3d& p : piece.body.vertices) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    EXPECT_LT((low - Eigen::Vector3d(7.2, 0.2, 0.0)).norm(), 1e-9) << name;
    EXPECT_LT((high - Eigen::Vector3d(8.8, 2.2, 0.9)).norm(), 1e-9) << name;
    const Obstacle& built = both.as_built.building.obstacles.back();
    EXPECT_EQ(built.id, "furniture_3");
    EXPECT_EQ(built.kind, piece.kind);
    EXPECT_FALSE(built.planned);
  }
}

TEST(PlanFurniture, ShapesOfFurnitureKeepTheirNames) {
  for (std::size_t i = 0; i < EnumNames<FurnitureShape>::names.size(); ++i) {
    const auto shape = static_cast<FurnitureShape>(i);
    const ClutterShape clutter = clutter_shape_of(shape);
    EXPECT_EQ(EnumNames<ClutterShape>::names[static_cast<std::size_t>(clutter)], EnumNames<FurnitureShape>::names[i]);
    EXPECT_EQ(furniture_of(clutter), shape);
  }
  EXPECT_FALSE(furniture_of(ClutterShape::box));
  EXPECT_FALSE(furniture_of(ClutterShape::cylinder));
}

TEST(PlanFurniture, UnknownShapesAreRefused) {
  std::string text = house;
  text.replace(text.find("shape: bed"), 10, "shape: bet");
  EXPECT_THROW((void)read_plan_text(text, "house.plan.yaml"), InputError);
}

TEST(PlanFurniture, AFurnishedPlanIsWrittenAndReadBack) {
  PlanFile furnished = plan();
  const std::size_t added = furnish_plan(furnished, options(0.2)).size();
  EXPECT_GT(added, 10U);
  EXPECT_EQ(furnished.clutter.size(), added + 1);
  const std::string text = write_plan(furnished, "furnished");
  const PlanFile again = plan_entries(read_yaml(text, "again.plan.yaml"));
  EXPECT_EQ(write_plan(again, "furnished"), text);
  EXPECT_EQ(again.deviations.size(), 2U);
  // The copy has all of it too.
  EXPECT_EQ(read_plan_text(text, "again.plan.yaml").obstacles.size(), 2 * furnished.clutter.size());
}

TEST(PlanFurniture, AFurnishedBuildingComesBackFromIfc) {
  PlanFile furnished = plan();
  furnish_plan(furnished, options(0.3));
  const Building building = read_plan_text(write_plan(furnished), "house.plan.yaml");
  const std::string text = write_ifc(building);
  const Building back = read_ifc_text(text, "house.ifc");
  EXPECT_EQ(back.hash(), building.hash());
  // Another program's file is interpreted: furniture stays furniture, with all its parts.
  std::string foreign = text;
  foreign.replace(foreign.find("'Plumbline ["), 10, "'Elsewhere");
  const Building read = read_ifc_text(foreign, "house.ifc");
  ASSERT_EQ(read.obstacles.size(), building.obstacles.size());
  double volume_read = 0.0, volume_built = 0.0;
  for (const Obstacle& obstacle : read.obstacles) {
    EXPECT_EQ(obstacle.kind, "furniture");
    volume_read += volume(obstacle.body);
  }
  for (const Obstacle& obstacle : building.obstacles) volume_built += volume(obstacle.body);
  EXPECT_NEAR(volume_read, volume_built, 1e-3 * volume_built);
}

TEST(PlanFurniture, SuitsCopiesAndWhatWasBuiltOtherwise) {
  PlanFile furnished = plan();
  furnish_plan(furnished, options(0.3));
  const PlanWithDeviations both = read_plan_with_deviations(write_plan(furnished), "house.plan.yaml");
  for (const Building* building : {&both.as_planned, &both.as_built.building})
    for (int storey = 0; storey < 2; ++storey) {
      Building floor = *building;
      std::erase_if(floor.rooms, [&](const Room& room) { return room.storey != storey; });
      std::vector<Polygon2> bare, standing;
      for (const Wall& wall : floor.walls)
        if (wall.id == "own" && storey == 1) bare.push_back({{2, 3.95}, {4, 3.95}, {4, 4.05}, {2, 4.05}});
      for (const Obstacle& obstacle : building->obstacles) {
        if (obstacle.storey != storey) continue;
        const Polygon2 outline = hull_of(obstacle);
        for (const Polygon2& other : standing) EXPECT_LT(intersection_area(outline, other), 1e-9) << obstacle.id;
        for (const Polygon2& other : bare) EXPECT_LT(intersection_area(outline, other), 1e-9) << obstacle.id;
        standing.push_back(outline);
      }
      for (const Opening& opening : floor.openings) {
        const Wall& wall = floor.walls[static_cast<std::size_t>(opening.wall)];
        if (wall.storey != storey) continue;
        const double y = opening.s_m;  // the wall goes up along x = 5
        const Polygon2 before = {{4.1, y - 0.55}, {5.9, y - 0.55}, {5.9, y + 0.55}, {4.1, y + 0.55}};
        for (const Polygon2& other : standing) EXPECT_LT(intersection_area(before, other), 1e-9) << opening.id;
      }
    }
}

TEST(PlanFurniture, TooManyEntriesAreRefused) {
  PlanFile full = plan();
  PlanClutterEntry entry = full.clutter.front();
  entry.shape = ClutterShape::box;
  entry.at = {-50, -50};
  entry.size = {0.1, 0.1};
  full.deviations.clear();
  while (full.clutter.size() < plan_entries_max) {
    entry.id = "far_" + std::to_string(full.clutter.size());
    full.clutter.push_back(entry);
  }
  EXPECT_THROW((void)furnish_plan(full, options(0.2)), InputError);
}

}  // namespace
}  // namespace plumbline::bim
