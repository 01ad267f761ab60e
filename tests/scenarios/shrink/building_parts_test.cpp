// SPDX-License-Identifier: Apache-2.0
#include "scenarios/shrink/building_parts.h"

#include <gtest/gtest.h>

#include "tests/data.h"
#include "tests/input_error.h"

namespace plumbline::scenarios {
namespace {

Tree house() {
  const std::string path = project_file("scenarios/library/house.plan.yaml");
  return *plan_tree(read_text_file(path), path);
}

Kept all_but(std::size_t count, std::size_t gone) {
  Kept kept;
  for (std::size_t i = 0; i < count; ++i)
    if (i != gone) kept.push_back(i);
  return kept;
}

std::size_t index_of(const Tree& plan, const std::string& kind, const std::string& id) {
  const Tree::List& list = plan.find(kind)->as_list();
  for (std::size_t i = 0; i < list.size(); ++i)
    if (list[i].find("id")->as_string() == id) return i;
  throw std::runtime_error("no " + id);
}

TEST(BuildingParts, OnlyPlansCanBeTakenApart) {
  EXPECT_FALSE(plan_tree("ISO-10303-21;", "building.ifc"));
  EXPECT_FALSE(plan_tree("levels: {}\n", "building.plan.yaml"));
  EXPECT_TRUE(plan_tree("plan: 1\n", "building.plan.yaml"));
}

TEST(BuildingParts, WithAllOfThemNothingChanges) {
  const Tree plan = house();
  for (const std::string& kind : kinds_of_parts()) {
    const std::size_t count = parts_in(plan, kind);
    EXPECT_EQ(parts_in(with_parts(plan, kind, all_but(count, count))), parts_in(plan)) << kind;
  }
  EXPECT_GT(parts_in(plan), 10U);
}

TEST(BuildingParts, WhatStandsInAWallGoesWithIt) {
  const Tree plan = house();
  const std::string wall = plan.find("openings")->as_list().front().find("wall")->as_string();
  std::size_t in_it = 0;
  for (const Tree& opening : plan.find("openings")->as_list())
    in_it += opening.find("wall")->as_string() == wall ? 1 : 0;
  const Tree fewer = with_parts(plan, "walls", all_but(parts_in(plan, "walls"), index_of(plan, "walls", wall)));
  EXPECT_EQ(parts_in(fewer, "openings"), parts_in(plan, "openings") - in_it);
  for (const Tree& opening : fewer.find("openings")->as_list()) EXPECT_NE(opening.find("wall")->as_string(), wall);
}

TEST(BuildingParts, AStoreyGoesWithAllThatStandsOnIt) {
  const Tree plan = read_yaml(
      "plan: 1\nstoreys: [{id: g}, {id: u, elevation_m: 3}]\n"
      "walls: [{id: w, storey: g, a: [0, 0], b: [5, 0]}, {id: x, storey: u, a: [0, 0], b: [5, 0]}]\n"
      "openings: [{id: d, wall: x, s_m: 2, width_m: 1, height_m: 2}]\n"
      "columns: [{id: c, storey: u, at: [1, 1], size: [0.2, 0.2]}]\n"
      "materials: [{id: brick, reflectivity: 0.3}]\n"
      "deviations: [{op: remove_opening, opening: d}, {op: move_wall, wall: w, by: [0, 1]}]\n"
      "symmetry: {exact: true}\n",
      "two.plan.yaml");
  const Tree ground = with_parts(plan, "storeys", {0});
  EXPECT_EQ(parts_in(ground), 3U) << write_yaml(ground);  // its storey, its wall, the wall's deviation
  EXPECT_EQ(ground.find("symmetry"), nullptr);
  EXPECT_TRUE(ground.find("materials")->as_list().empty());
}

TEST(BuildingParts, ElementsOfOneIdButOtherKindsStay) {
  const Tree plan = read_yaml(
      "plan: 1\nstoreys: [{id: a}]\n"
      "walls: [{id: a, storey: a, a: [0, 0], b: [5, 0]}, {id: b, storey: a, a: [0, 0], b: [0, 5]}]\n"
      "openings: [{id: a, wall: a, s_m: 2, width_m: 1, height_m: 2}, {id: b, wall: b, s_m: 2, width_m: 1, height_m: "
      "2}]\n"
      "rooms: [{id: a, storey: a, walls: [a, b]}]\n"
      "columns: [{id: a, storey: a, at: [1, 1], size: [0.2, 0.2]}]\n"
      "deviations: [{op: remove_opening, opening: a}, {op: move_wall, wall: a, by: [0, 1]}, "
      "{op: move_wall, wall: b, by: [0, 1]}]\n",
      "same.plan.yaml");
  for (const char* kind : {"rooms", "columns"})
    EXPECT_EQ(parts_in(with_parts(plan, kind, {})), parts_in(plan) - 1) << kind;
  const Tree without_opening = with_parts(plan, "openings", {1});
  EXPECT_EQ(parts_in(without_opening, "deviations"), 2U) << write_yaml(without_opening);
  EXPECT_EQ(without_opening.find("rooms")->as_list().front().find("walls")->as_list().size(), 2U);
  const Tree without_wall = with_parts(plan, "walls", {1});
  EXPECT_EQ(parts_in(without_wall, "openings"), 1U) << write_yaml(without_wall);
  EXPECT_EQ(parts_in(without_wall, "deviations"), 1U) << write_yaml(without_wall);
  EXPECT_EQ(parts_in(without_wall, "columns"), 1U) << write_yaml(without_wall);
}

TEST(BuildingParts, OfThoseThatMakeNoPlanTheTextIsRefused) {
  EXPECT_NO_THROW((void)plan_text(house()));
  const std::string error = input_error([] { (void)plan_text(with_parts(house(), "storeys", {})); });
  EXPECT_NE(error.find("storeys"), std::string::npos) << error;
}

}  // namespace
}  // namespace plumbline::scenarios
