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

TEST(Permanence, WhatWasBuiltHasNotMoved) {
  for (const char* kind : {"railing", "sanitary_terminal"}) EXPECT_FALSE(may_have_moved(obstacle(kind))) << kind;
  for (const char* kind : {"furniture", "box"}) EXPECT_TRUE(may_have_moved(obstacle(kind))) << kind;
  EXPECT_TRUE(may_have_moved(obstacle("railing", false))) << "not planned";
}

TEST(Permanence, WhatHasNoCounterpartIsGone) {
  Building as_built;
  as_built.obstacles.push_back(obstacle("box"));
  as_built.obstacles.back().id = "a";
  Obstacle planned = as_built.obstacles.back();
  EXPECT_FALSE(is_gone(planned, as_built));
  planned.id = "b";
  EXPECT_TRUE(is_gone(planned, as_built));
}

}  // namespace
}  // namespace plumbline::bim
