// SPDX-License-Identifier: Apache-2.0
#include "bim/model/permanence.h"

#include <gtest/gtest.h>

#include <utility>

namespace plumbline::bim {
namespace {

Obstacle obstacle(const char* kind, bool planned = true) {
  Obstacle made;
  made.id = kind;
  made.kind = kind;
  made.planned = planned;
  return made;
}

TEST(Permanence, FollowsTheKindAndWhetherItWasPlanned) {
  const std::pair<const char*, Permanence> expected[] = {
      {"door_leaf", Permanence::structure},     {"railing", Permanence::structure},
      {"covering", Permanence::structure},      {"beam", Permanence::structure},
      {"sanitary_terminal", Permanence::fixed}, {"box", Permanence::furniture},
      {"cylinder", Permanence::furniture},      {"furniture", Permanence::furniture},
      {"proxy", Permanence::furniture}};
  for (const auto& [kind, permanence] : expected) {
    EXPECT_EQ(permanence_of(obstacle(kind)), permanence) << kind;
    EXPECT_EQ(permanence_of(obstacle(kind, false)), Permanence::clutter) << kind;
  }
}

TEST(Permanence, WithoutMovablesKeepsWhatWasBuilt) {
  Building building;
  for (const char* kind : {"railing", "furniture", "sanitary_terminal", "box"})
    building.obstacles.push_back(obstacle(kind));
  building.obstacles.push_back(obstacle("railing", false));
  const Building left = without_movables(building);
  ASSERT_EQ(left.obstacles.size(), 2U);
  EXPECT_EQ(left.obstacles[0].kind, "railing");
  EXPECT_EQ(left.obstacles[1].kind, "sanitary_terminal");
}

}  // namespace
}  // namespace plumbline::bim
