// SPDX-License-Identifier: Apache-2.0
#include "scenarios/shrink/ingredients.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "scenarios/spec/scenario.h"

namespace plumbline::scenarios {
namespace {

Tree scenario(const std::string& more) {
  return read_yaml("scenario: 1\nbuilding: a.plan.yaml\nroute: {rooms: [a, b]}\n" + more, "a.yaml");
}

/// Everything that can be one.
const char* const rich =
    "people: [{rooms: [a]}, {points: [[1, 1], [2, 2]]}, {rooms: [b]}]\n"
    "moving_doors: [{door: d}]\nfaults: {slip_mps: 0.3}\npushes: {max_n: 20}\n"
    "kidnap: {after_s: 5, to: {room: b}}\nground: {friction: 0.4}\nworld: {furniture: moved}\n"
    "furnish: {density: 0.1}\nlidar: {preset: real, rpm: 1200, optics: true}\nodometry: {preset: uncorrected}\n"
    "prior: {yaw: unknown, storey: known}\n";

std::vector<std::string> names_of_every(const std::vector<Ingredient>& ingredients) {
  std::vector<std::string> names;
  for (const Ingredient& ingredient : ingredients) names.push_back(ingredient.name);
  return names;
}

TEST(Ingredients, AreWhatTheSimplestWalkDoesNotHave) {
  const std::vector<std::string> expected = {"people 1",
                                             "people 2",
                                             "people 3",
                                             "moving_doors 1",
                                             "kidnap",
                                             "pushes.max_n: 20",
                                             "faults.slip_mps: 0.3",
                                             "ground.friction: 0.4",
                                             "world.furniture: moved",
                                             "lidar.preset: real",
                                             "lidar.rpm: 1200",
                                             "lidar.optics: true",
                                             "odometry.preset: uncorrected",
                                             "prior.yaw: unknown",
                                             "furnish"};
  EXPECT_EQ(names_of_every(ingredients_of(scenario(rich))), expected);
}

TEST(Ingredients, WithoutAllOfThemThereAreNone) {
  const Tree simple = with_ingredients(scenario(rich), ingredients_of(scenario(rich)), {});
  EXPECT_TRUE(ingredients_of(simple).empty()) << write_yaml(simple);
  EXPECT_NO_THROW((void)read_scenario(write_yaml(simple), "simple.yaml"));
}

TEST(Ingredients, AnyOneCanGoAloneAndTheOthersStay) {
  const Tree whole = scenario(rich);
  const std::vector<Ingredient> all = ingredients_of(whole);
  for (std::size_t gone = 0; gone < all.size(); ++gone) {
    Kept kept;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (i != gone) kept.push_back(i);
    const Tree less = with_ingredients(whole, all, kept);
    EXPECT_EQ(ingredients_of(less).size(), all.size() - 1) << all[gone].name;
    for (std::size_t i = 0; i < all.size(); ++i)
      EXPECT_EQ(is_left(all[i], whole, less), i != gone) << all[i].name << " without " << all[gone].name;
  }
}

TEST(Ingredients, PresetsHaveEffectsThatCanGoOneByOne) {
  const Tree harsh = scenario("lidar: {preset: ideal}\nfaults: {preset: harsh, slip_mps: 0.1}\n");
  const std::vector<Ingredient> effects = effects_of(harsh);
  const std::vector<std::string> names = names_of_every(effects);
  EXPECT_NE(std::find(names.begin(), names.end(), "faults.gyro_bias_radps"), names.end());
  EXPECT_EQ(std::find(names.begin(), names.end(), "faults.slip_mps"), names.end());  // an ingredient of its own
  EXPECT_EQ(std::find(names.begin(), names.end(), "lidar.range_noise"), names.end());
  const Tree without = with_ingredients(harsh, effects, {});
  EXPECT_TRUE(effects_of(without).empty());
  EXPECT_EQ(ingredients_of(without).size(), ingredients_of(harsh).size());  // what is off is none
  EXPECT_FALSE(effects_of(scenario("lidar: {preset: real}\n")).empty());
}

}  // namespace
}  // namespace plumbline::scenarios
