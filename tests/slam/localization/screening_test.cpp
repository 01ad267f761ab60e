// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <vector>

#include "slam/localization/hypotheses.h"
#include "tests/slam/localization/twin_rooms.h"

namespace plumbline::slam {
namespace {

TEST(Hypotheses, AFirstLookByFewColumnsRulesOutNothingThatAllWouldKeep) {
  const TwinRooms twins = twin_rooms_scans();
  HypothesisComparisonConfig hardly_telling;
  hardly_telling.weight = 0.001;  // keeps what the default rules out
  const auto hypotheses_after_trying_many = [&](const HypothesisComparisonConfig& comparison, int columns,
                                                double margin) {
    HypothesisConfig config;
    config.screening_columns = columns;
    config.screening_margin = margin;
    HypothesisSet set(config, {}, {}, comparison);
    track_and_add_twin(twins, set);
    std::vector<StoreyPose> poses;
    for (int x = -1; x <= 4; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int turn = 0; turn < 4; ++turn)
          poses.push_back({0, twins.here * Pose2{{1.8 * x, 0.9 * y}, 1.57 * turn}, turn % 2 == 0});
    set.add(twins.index, poses);
    set.prune_and_normalize();
    return set.all();
  };
  const auto expect_same = [&](const HypothesisComparisonConfig& comparison, int columns, double margin) {
    const std::vector<PoseHypothesis> all = hypotheses_after_trying_many(comparison, 1, margin);
    const std::vector<PoseHypothesis> few = hypotheses_after_trying_many(comparison, columns, margin);
    ASSERT_EQ(few.size(), all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_EQ(few[i].X_IH.t, all[i].X_IH.t);
      EXPECT_EQ(few[i].evidence, all[i].evidence);
    }
  };
  expect_same({}, 8, HypothesisConfig{}.screening_margin);
  expect_same(hardly_telling, 8, 0.0);
  EXPECT_LT(hypotheses_after_trying_many({}, 8, 0.0).size(), hypotheses_after_trying_many({}, 1, 0.0).size())
      << "without a margin it rules out poses by itself";
}

}  // namespace
}  // namespace plumbline::slam
