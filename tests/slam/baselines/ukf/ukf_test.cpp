// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/ukf/ukf.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bim/errors.h"
#include "tests/slam/baselines/plan_walk.h"
#include "tests/slam/localization/house_plan.h"

namespace plumbline::slam {
namespace {

TEST(Ukf, StartsBySearchAndTracks) {
  const synthetic::Recording recording = synthetic::biased_walk(2.5);
  const bim::Plan plan = synthetic::plan_of(synthetic::corridor_house());
  for (const std::string motion : {"constant_velocity", "odometry"}) {
    const auto answers = synthetic::localize("ukf", recording, plan, motion == "odometry", "motion: " + motion);
    EXPECT_EQ(answers.outputs.front().state, State::converged) << "believes its search at once";
    EXPECT_EQ(answers.outputs.back().state, State::converged);
    EXPECT_LT(synthetic::last_error(answers, recording), 0.15) << motion;
    const Eigen::Matrix3d& P = answers.outputs.back().hypotheses.front().covariance;
    EXPECT_GT(P.determinant(), 0.0);
    EXPECT_LT(P.diagonal().maxCoeff(), 0.1);
  }
}

/// Position error of a walk's answers, m rms.
double rms(const synthetic::PlanWalkAnswers& answers, const synthetic::Recording& recording) {
  double sum = 0.0;
  for (std::size_t i = 0; i < answers.outputs.size(); ++i)
    sum += (answers.outputs[i].X_FR.value().t - recording.truth[i].X_FR.t).squaredNorm();
  return std::sqrt(sum / static_cast<double>(answers.outputs.size()));
}

// Through a door and round a room: a registration that stops early leaves the velocity of before the turn.
TEST(Ukf, HoldsConstantVelocityThroughTurns) {
  const synthetic::Recording recording = synthetic::biased_walk(12.0);
  const bim::Plan plan = synthetic::plan_of(synthetic::corridor_house());
  const auto answers = synthetic::localize("ukf", recording, plan, true, "motion: constant_velocity");
  EXPECT_LT(rms(answers, recording), 0.04);
  EXPECT_EQ(answers.outputs.back().state, State::converged);
}

/// An IMU without errors at 100 Hz, up to a time, s.
std::vector<Imu> imu_of_walk(double until) {
  constexpr double h = 1e-3;
  const auto X_WR = [](double t) { return synthetic::walk_pose(synthetic::corridor_house_walk(), {}, t); };
  std::vector<Imu> records;
  for (int i = 1; 0.01 * i < until; ++i) {
    const double t = 0.01 * i;
    const Pose before = X_WR(t - h), now = X_WR(t), after = X_WR(t + h);
    const Eigen::Vector3d a_W = (after.t - 2.0 * now.t + before.t) / (h * h) + Eigen::Vector3d(0.0, 0.0, 9.80665);
    Imu imu;
    imu.stamp = std::llround(1e9 * t);
    imu.linear_acceleration_R = now.q.conjugate() * a_W;
    imu.angular_velocity_R = log_so3(before.q.conjugate() * after.q) / (2.0 * h);
    records.push_back(imu);
  }
  return records;
}

TEST(Ukf, TracksByItsImuAndWhereThatFallsSilent) {
  synthetic::Recording recording = synthetic::biased_walk(4.0);
  const bim::Plan plan = synthetic::plan_of(synthetic::corridor_house());
  for (const double until : {4.0, 1.5}) {
    recording.imu = imu_of_walk(until);
    const auto answers = synthetic::localize("ukf", recording, plan, true);
    EXPECT_EQ(answers.outputs.back().state, State::converged);
    EXPECT_LT(synthetic::last_error(answers, recording), 0.1) << "IMU for " << until << " s";
  }
}

TEST(Ukf, IsLostWhereScansDoNotFit) {
  const synthetic::Recording recording = synthetic::biased_walk(1.2);
  const bim::Plan plan = synthetic::plan_of(synthetic::one_room(30.0, 25.0));
  for (const std::string again : {"false", "true"}) {
    const auto answers = synthetic::localize("ukf", recording, plan, true,
                                             "lost_scans: 3\nlost_inliers: 0.9\nmotion: odometry\nsearch: {cell_m: "
                                             "1}\nndt: {max_iterations: 4}\nrelocalize: " +
                                                 again);
    const auto lost = [](const Output& output) { return output.state == State::lost; };
    EXPECT_TRUE(std::any_of(answers.outputs.begin(), answers.outputs.end(), lost));
    EXPECT_EQ(again == "true", std::any_of(answers.outputs.begin() + 4, answers.outputs.end(),
                                           [&](const Output& output) { return !lost(output); }));
  }
}

TEST(Ukf, SaysWhatIsMissing) { EXPECT_THROW(static_cast<void>(make_ukf({})), InputError); }

}  // namespace
}  // namespace plumbline::slam
