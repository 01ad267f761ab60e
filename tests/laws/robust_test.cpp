// SPDX-License-Identifier: Apache-2.0
// Whatever the sensors send, a method answers every scan with a stated state and finite numbers.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "slam/methods.h"
#include "tests/laws/walk.h"

namespace plumbline {
namespace {

using slam::Nanoseconds;

const SimulatedWalk& walk_to_another_room() {
  static const SimulatedWalk walk = walk_quickstart(3, {"office_a", "corridor", "kitchen"}, 11.0);
  return walk;
}

constexpr std::size_t duplicate_at = 20, blind_at = 25, no_columns_at = 28, nonsense_at = 31, gap_from = 34,
                      gap_to = 54, jump_at = 62, nonsense_odometry_at = 70, kidnapped_at = 80;

void blind(slam::Scan& scan) { std::fill(scan.range_m.begin(), scan.range_m.end(), 0.0); }

void drop_columns(slam::Scan& scan) {
  scan.columns = 0;
  scan.range_m.clear();
  scan.point_L.clear();
  scan.offset_ns.clear();
  scan.reflectivity.clear();
}

/// Every third return is no number, infinite or out of this world.
void spoil(slam::Scan& scan) {
  const double bad[] = {std::nan(""), std::numeric_limits<double>::infinity(), 1e30, -1e30};
  for (std::size_t i = 0; i < scan.size(); i += 3) {
    const double value = bad[(i / 3) % 4];
    if (i % 2 == 0) scan.range_m[i] = value;
    scan.point_L[i] = Eigen::Vector3d(value, 1.0, value);
  }
}

/// One walk with every fault in it: a scan twice, scans without returns and without columns, returns that are no
/// numbers, 2 s without anything, odometry that jumps by 1 km and 37 degrees, odometry that is no number, and at the
/// end a robot that stands still for its legs and is back where it began for its eyes.
std::vector<slam::SensorFrame> faulty(const std::vector<slam::SensorFrame>& good) {
  const Pose jump = Pose::from_xyz_yaw({1000.0, -500.0, 0.0}, 37.0 * std::numbers::pi / 180.0);
  std::vector<slam::SensorFrame> frames;
  for (std::size_t k = 0; k < good.size(); ++k) {
    if (k >= gap_from && k < gap_to) continue;
    slam::SensorFrame frame;
    frame.imu = good[k].imu;
    frame.odometry = good[k].odometry;
    frame.scan = good[k].scan;
    if (k >= blind_at && k < no_columns_at) blind(frame.scan);
    if (k == no_columns_at) drop_columns(frame.scan);
    if (k >= nonsense_at && k < nonsense_at + 2) spoil(frame.scan);
    if (k >= jump_at)
      for (auto& odometry : frame.odometry) odometry.X_OR = jump * odometry.X_OR;
    if (k >= nonsense_odometry_at && k < nonsense_odometry_at + 3)
      for (auto& odometry : frame.odometry) odometry.X_OR.t.x() = std::nan("");
    if (k >= kidnapped_at) {
      const Pose X_OR = jump * good[kidnapped_at].odometry.back().X_OR;
      for (auto& odometry : frame.odometry) odometry.X_OR = X_OR;
      frame.scan = good[k - kidnapped_at].scan;
      frame.scan.stamp = good[k].scan.stamp;
    }
    frames.push_back(frame);
    if (k == duplicate_at) {
      frames.push_back(frame);
      frames.back().imu.clear();
      frames.back().odometry.clear();
    }
  }
  return frames;
}

bool finite(const Pose& X) { return X.t.allFinite() && X.q.coeffs().allFinite() && std::abs(X.q.norm() - 1.0) < 1e-6; }

/// Written after references that have no notion of their health: what they see is matched wherever they are.
bool knows_its_health(const std::string& method) {
  for (const char* without : {"odometry", "kiss_icp", "lego_loam", "mloam", "hdl_slam_paper"})
    if (method.starts_with(without)) return false;
  return true;
}

class Robust : public ::testing::TestWithParam<std::string> {};

TEST_P(Robust, FaultyInputsEndInAStatedState) {
  const SimulatedWalk& walk = walk_to_another_room();
  const auto frames = faulty(walk.frames);
  const Answer answer = answer_of(GetParam(), method_input(walk, GetParam()), frames);
  ASSERT_EQ(answer.outputs.size(), frames.size());
  bool lost_after_kidnapping = false;
  const bool localizes = slam::find_method(GetParam())->needs_plan;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const slam::Output& output = answer.outputs[k];
    EXPECT_EQ(output.stamp, frames[k].scan.stamp);
    // SLAM answers every scan, converged or lost. A localization that reports convergence answers, too.
    const bool converged = output.state == slam::State::converged;
    EXPECT_TRUE(localizes || converged || output.state == slam::State::lost) << "scan " << k;
    EXPECT_TRUE(output.X_FR.has_value() || (localizes && !converged)) << "scan " << k;
    if (output.X_FR) {
      EXPECT_TRUE(finite(*output.X_FR)) << "scan " << k;
      EXPECT_LT(output.X_FR->t.norm(), 100.0) << "scan " << k << ": the jump is not the robot's";
    }
    for (const auto& hypothesis : output.hypotheses) EXPECT_TRUE(finite(hypothesis.X_WR)) << "scan " << k;
    const bool kidnapped = frames[k].scan.stamp >= walk.frames[kidnapped_at].scan.stamp;
    lost_after_kidnapping |= kidnapped && output.state == slam::State::lost;
  }
  if (!localizes && knows_its_health(GetParam())) {
    EXPECT_TRUE(lost_after_kidnapping);
  }
  for (const auto& pose : answer.estimate.trajectory) EXPECT_TRUE(finite(pose.X_FR));
  for (const auto& plane : answer.estimate.planes) EXPECT_TRUE(plane.plane_F.n.allFinite() && plane.p0.allFinite());
  for (const auto& room : answer.estimate.rooms) EXPECT_TRUE(room.center_F.allFinite());
  for (const auto& floor : answer.estimate.floors) EXPECT_TRUE(floor.center_F.allFinite());
  for (const auto& point : answer.estimate.map_F) EXPECT_TRUE(point.allFinite());
}

TEST_P(Robust, NothingAtAllEndsInAStatedState) {
  const SimulatedWalk& walk = walk_to_another_room();
  std::vector<slam::SensorFrame> frames(walk.frames.begin(), walk.frames.begin() + 15);
  for (std::size_t k = 0; k < frames.size(); ++k)
    if (k < 3)
      drop_columns(frames[k].scan);
    else
      blind(frames[k].scan);
  const Answer answer = answer_of(GetParam(), method_input(walk, GetParam()), frames);
  ASSERT_EQ(answer.outputs.size(), frames.size());
  for (const auto& output : answer.outputs)
    if (output.X_FR) {
      EXPECT_TRUE(finite(*output.X_FR));
    }
  if (GetParam() != "odometry") {
    EXPECT_NE(answer.outputs.back().state, slam::State::converged) << "without a single return";
  }
}

INSTANTIATE_TEST_SUITE_P(Laws, Robust, ::testing::ValuesIn(all_methods()), [](const auto& info) { return info.param; });

}  // namespace
}  // namespace plumbline
