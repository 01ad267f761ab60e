// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/dotted_key.h"

#include <gtest/gtest.h>

namespace plumbline::scenarios {
namespace {

Tree tree() { return read_yaml("a: 1\nb: {c: 2, d: {e: 3}}\nl: [1, 2]\n", "t.yaml"); }

TEST(DottedKey, IsFoundBelowMapsOnly) {
  EXPECT_EQ(find_at(tree(), "a")->as_int(), 1);
  EXPECT_EQ(find_at(tree(), "b.d.e")->as_int(), 3);
  for (const char* none : {"x", "b.x", "a.c", "l.c", "b.d.e.f", "", "b."})
    EXPECT_EQ(find_at(tree(), none), nullptr) << none;
}

TEST(DottedKey, SettingLeavesItsNeighbours) {
  Tree changed = tree();
  set_at(changed, "b.d.e", Tree(4));
  set_at(changed, "x.y", Tree(5));
  set_at(changed, "a.z", Tree(6));  // a map stands in for a number
  EXPECT_EQ(write_json(changed, 0), R"({"a":{"z":6},"b":{"c":"2","d":{"e":4}},"l":["1","2"],"x":{"y":5}})");
}

TEST(DottedKey, ErasingWhatIsNotThereDoesNothing) {
  Tree changed = tree();
  erase_at(changed, "b.x");
  erase_at(changed, "a.b");
  EXPECT_EQ(write_json(changed), write_json(tree()));
  erase_at(changed, "b.d.e");
  erase_at(changed, "a");
  EXPECT_EQ(write_json(changed, 0), R"({"b":{"c":"2","d":{}},"l":["1","2"]})");
}

}  // namespace
}  // namespace plumbline::scenarios
