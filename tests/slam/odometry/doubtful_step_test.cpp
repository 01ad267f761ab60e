// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/doubtful_step.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <numbers>

#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

constexpr double pi = std::numbers::pi;

synthetic::House room(bool furnished) {
  synthetic::House house = synthetic::one_room();
  if (furnished) house.boxes.push_back({{4.2, 0.4, 0.0}, {5.6, 1.4, 1.6}});
  return house;
}

Pose at(double x_m, double y_m, double yaw_rad = 0.0) { return Pose::from_xyz_yaw({x_m, y_m, 0.0}, yaw_rad); }

/// Of a robot that stands.
DeskewedScan seen(const synthetic::House& house, const Pose& X_WR, std::uint64_t k) {
  Scan scan = synthetic::standing_scan(house, X_WR, {.seed = k + 1});
  scan.stamp = static_cast<Nanoseconds>(k) * 500'000'000;
  MotionBuffer motion;
  motion.add({scan.stamp, Pose{}});
  return deskew(scan, motion, synthetic::calibration());
}

VgicpConfig surfaces_alone() {
  VgicpConfig config;
  config.odometry_prior = config.tilt_prior = false;
  return config;
}

/// A matcher whose map has three views of the room, and a robot that was seen to turn right about, although it was
/// expected to stand. Then views of the room from where it goes; truly: it did turn.
class Turned {
 public:
  Turned(bool furnished, bool truly) : house_(room(furnished)), truly_(truly), matcher_(surfaces_alone()) {
    for (const double x_m : {2.4, 2.7, 3.0}) see(at(x_m, 2.0), at(x_m, 2.0));
    doubt_ = std::make_unique<DoubtfulStep>(
        matcher_, DoubtfulStep::Scan{at(3.0, 2.0), at(0.0, 0.0, pi), Pose{}, 0.9, 0.02, 0.85});
  }

  /// From where it is believed to be. mapped: the view enters the map.
  void go(double x_m, double y_m, bool mapped = false) {
    const Pose believed = at(x_m, y_m, pi), turned_back = at(3.0, 2.0, pi).inverse() * believed;
    const Pose truth = truly_ ? believed : at(3.0, 2.0) * turned_back;
    match(truth, believed);
    doubt_->add(matcher_, believed, true);
    matcher_.commit(believed, mapped);
  }
  [[nodiscard]] DoubtfulStep& doubt() { return *doubt_; }
  [[nodiscard]] const VgicpOdometry& matcher() const { return matcher_; }

 private:
  void match(const Pose& truth, const Pose& believed) {
    OdometrySample sample;
    sample.valid = false;
    sample.step = X_MR_.inverse() * believed;
    X_MR_ = believed;
    (void)matcher_.match(seen(house_, truth, k_++), sample);
  }
  void see(const Pose& truth, const Pose& believed) {
    match(truth, believed);
    matcher_.commit(believed, true);
  }

  synthetic::House house_;
  bool truly_;
  VgicpOdometry matcher_;
  Pose X_MR_;
  std::uint64_t k_ = 0;
  std::unique_ptr<DoubtfulStep> doubt_;
};

void go_round(Turned& robot, bool mapped = false) {
  for (int k = 0; k < 6; ++k) robot.go(2.8 - 0.35 * (k % 3), 1.8 + 0.35 * (k / 3), mapped);
}

TEST(DoubtfulStep, IsSettledByViewsThatFitTheMapOfBeforeThereAlone) {
  Turned robot(true, true);
  go_round(robot);
  EXPECT_TRUE(robot.doubt().is_settled());
}

TEST(DoubtfulStep, StaysWhereViewsFitAsWellAfterTheExpectedStep) {
  for (const bool truly : {true, false}) {
    Turned robot(false, truly);
    go_round(robot);
    EXPECT_FALSE(robot.doubt().is_settled()) << "the empty room looks the same from both sides";
  }
}

TEST(DoubtfulStep, StaysWhereViewsFitWhatWasMappedSinceAlone) {
  Turned robot(true, false);
  go_round(robot, true);
  go_round(robot, true);
  EXPECT_FALSE(robot.doubt().is_settled()) << "it did not turn: the furniture is on the other side";
}

TEST(DoubtfulStep, TakesViewsInARowFromDifferentPlaces) {
  Turned standing(true, true);
  for (int k = 0; k < 10; ++k) standing.go(2.8, 1.8);
  EXPECT_FALSE(standing.doubt().is_settled()) << "one view";
  Turned surprised(true, true);
  for (int k = 0; k < 8; ++k) {
    surprised.go(2.8 - 0.35 * (k % 3), 1.8 + 0.35 * (k / 3));
    if (k % 4 == 3) surprised.doubt().add(surprised.matcher(), {}, false);
  }
  EXPECT_FALSE(surprised.doubt().is_settled());
}

TEST(DoubtfulStep, IsDoubtedAgainByEachFurtherOne) {
  Turned robot(true, true);
  go_round(robot);
  const DoubtfulStep::Scan again{at(2.1, 2.15, pi), Pose{}, Pose{}, 0.9, 0.02, 0.85};
  robot.doubt().add_doubtful(again);
  EXPECT_FALSE(robot.doubt().is_settled());
  go_round(robot);
  EXPECT_TRUE(robot.doubt().is_settled());
  for (int k = 0; k < 4; ++k) robot.doubt().add_doubtful(again);
  go_round(robot);
  EXPECT_FALSE(robot.doubt().is_settled());
}

}  // namespace
}  // namespace plumbline::slam
