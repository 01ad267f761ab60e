// SPDX-License-Identifier: Apache-2.0
#include "slam/localize/contest.h"

#include <gtest/gtest.h>

#include "bim/random/stream.h"
#include "tests/slam/localize/house_plan.h"
#include "tests/slam/localize/house_view.h"

namespace plumbline::slam {
namespace {

constexpr double shift_x = 9.0, shift_y = 1.0;  // of the second of the twin rooms

synthetic::Box column_at(double x, double y, double height = 2.8) { return {{x, y, 0.0}, {x + 0.4, y + 0.4, height}}; }

/// Log-likelihood ratio of standing where one stands, in the first room, to standing in the other.
double here_against_there(const synthetic::House& planned, const synthetic::House& built, const Pose& X_WR,
                          std::uint64_t seed) {
  const PlanIndex index = make_plan_index(synthetic::plan_of(planned), "ground", {});
  const View view = synthetic::standing_view(built, X_WR, Pose{}, seed).view;
  Pose X_there = X_WR;
  X_there.t += Eigen::Vector3d(shift_x, shift_y, 0.0);
  const Pose X_IW = index.X_WI.inverse();
  const StoreyIndex& storey = index.storeys.front();
  const Sight here = sight(storey, heading(X_IW * X_WR), view, {}),
              there = sight(storey, heading(X_IW * X_there), view, {});
  const double ratio = contest(view, here, there, {}).ratio;
  EXPECT_EQ(contest(view, there, here, {}).ratio, -ratio);
  return ratio;
}

class ContestAt : public testing::TestWithParam<int> {
 protected:
  [[nodiscard]] Pose somewhere() const {
    const Stream stream(5, "slam.localize.init");
    const auto tick = static_cast<std::uint64_t>(GetParam());
    return Pose::from_xyz_yaw({1.0 + 2.0 * stream.uniform(tick, 0), 1.0 + 2.0 * stream.uniform(tick, 1), 0.46},
                              6.0 * stream.uniform(tick, 2));
  }
  const synthetic::House twins_ = synthetic::twin_rooms();
};

TEST_P(ContestAt, RoomsThatAreAlikeSayNothingOfEachOther) {
  EXPECT_EQ(here_against_there(twins_, twins_, somewhere(), 1), 0.0);
}

TEST_P(ContestAt, ClutterThatNoPlanShowsSaysNothing) {
  synthetic::House built = twins_;
  built.boxes.push_back(column_at(4.2, 0.3));
  EXPECT_EQ(here_against_there(twins_, built, somewhere(), 2), 0.0);
}

TEST_P(ContestAt, AColumnTellsItsRoomFromTheOther) {
  synthetic::House here = twins_, there = twins_;
  here.boxes.push_back(column_at(4.2, 0.3));
  there.boxes.push_back(column_at(4.2 + shift_x, 0.3 + shift_y));
  const double seen = here_against_there(here, here, somewhere(), 3);
  const double missed = here_against_there(there, there, somewhere(), 4);
  EXPECT_GT(seen, 2.0);
  // Light that passes through the other room's column says more than light cut short, which clutter may do.
  EXPECT_GT(missed, 1.2 * seen);
}

TEST(Objections, NoFaceCountsForMoreThanTheCap) {
  Objections objections, more;
  for (int i = 0; i < 10; ++i) objections.add(3, true, 1.0);
  objections.add(3, false, 1.0);
  objections.add(-1, false, 2.0);
  EXPECT_EQ(objections.total(100.0), 13.0);
  EXPECT_EQ(objections.total(4.0), 7.0);
  more.add(8, true, 6.0);
  objections.add(more, 0.5);
  EXPECT_EQ(objections.total(4.0), 10.0);
  objections.clear();
  EXPECT_EQ(objections.total(4.0), 0.0);
}

INSTANTIATE_TEST_SUITE_P(Places, ContestAt, testing::Range(0, 6));

}  // namespace
}  // namespace plumbline::slam
