// SPDX-License-Identifier: Apache-2.0
#include "scenarios/run/record.h"

#include <gtest/gtest.h>

namespace plumbline::scenarios {
namespace {

TEST(MethodRecord, AllItsTimesAreShifted) {
  MethodRecord record;
  record.causal = {{1, Pose()}};
  record.beliefs.push_back({2, slam::State::searching, {}, {}});
  record.lost = {{3, 4}};
  record.estimate.trajectory = {{5, Pose()}};
  record.estimate.loops = {{6, 7, Pose()}};
  record.estimate.segmented.push_back({8, Eigen::Vector3d::Zero(), {}, {}});
  record.estimate.graph.set("keyframes",
                            Tree::list().push(Tree::map().set("stamp_ns", std::int64_t{9}).set("storey", 1)));
  record.estimate.graph.set("planes", Tree::list());
  shift_times(record, 100);
  EXPECT_EQ(record.causal[0].stamp, 101);
  EXPECT_EQ(record.beliefs[0].stamp, 102);
  EXPECT_EQ(record.lost[0].from, 103);
  EXPECT_EQ(record.lost[0].to, 104);
  EXPECT_EQ(record.estimate.trajectory[0].stamp, 105);
  EXPECT_EQ(record.estimate.loops->at(0).from, 106);
  EXPECT_EQ(record.estimate.loops->at(0).to, 107);
  EXPECT_EQ(record.estimate.segmented[0].stamp, 108);
  const Tree& keyframe = record.estimate.graph.find("keyframes")->as_list().at(0);
  EXPECT_EQ(keyframe.find("stamp_ns")->as_int(), 109);
  EXPECT_EQ(keyframe.find("storey")->as_int(), 1);
  EXPECT_EQ(record.estimate.graph.as_map().size(), 2U);
  record.estimate.graph = Tree();
  shift_times(record, 100);
  EXPECT_TRUE(record.estimate.graph.is_null());
}

}  // namespace
}  // namespace plumbline::scenarios
