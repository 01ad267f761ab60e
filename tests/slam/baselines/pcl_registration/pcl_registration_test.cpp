// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/pcl_registration/pcl_registration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

using Make = std::function<std::unique_ptr<Method>(const MethodInput&, PclGuess)>;

struct Case {
  std::string name;
  Make make;
};

void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }

std::unique_ptr<Method> make_gicp(const MethodInput& input, PclGuess guess) {
  PclGicpMethodConfig config;
  config.local_map.guess = guess;
  return make_pcl_gicp_method(input, config);
}

std::unique_ptr<Method> make_ndt(const MethodInput& input, PclGuess guess) {
  PclNdtMethodConfig config;
  config.local_map.guess = guess;
  return make_pcl_ndt_method(input, config);
}

const synthetic::Recording& short_walk() {
  static const synthetic::Recording recording = [] {
    synthetic::WalkConfig config;
    config.duration_s = 5.0;
    return synthetic::walk(synthetic::corridor_house(), synthetic::corridor_house_walk(), config);
  }();
  return recording;
}

struct Options {
  PclGuess guess = PclGuess::odometry;
  bool odometry = true;
};

std::vector<Output> run(const Make& make, const synthetic::Recording& recording, const Options& options = {}) {
  MethodInput input;
  input.calibration = recording.calibration;
  input.has_odometry = options.odometry;
  const std::unique_ptr<Method> method = make(input, options.guess);
  std::vector<Output> outputs;
  std::size_t next = 0;
  for (const Scan& scan : recording.scans) {
    for (; next < recording.odometry.size() && recording.odometry[next].stamp <= scan.stamp; ++next)
      if (options.odometry) method->on_odometry(recording.odometry[next]);
    outputs.push_back(method->on_scan(scan));
  }
  EXPECT_EQ(method->finish().trajectory.size(), recording.scans.size());
  return outputs;
}

/// Largest distance to the truth, M placed by the first pose.
double largest_error(const std::vector<Output>& outputs, const synthetic::Recording& recording) {
  double worst = 0.0;
  const Pose X_WM = recording.truth.front().X_FR;
  for (std::size_t k = 0; k < outputs.size(); ++k)
    worst = std::max(worst, (recording.truth[k].X_FR.inverse() * X_WM * *outputs[k].X_FR).t.norm());
  return worst;
}

class PclRegistrationTest : public testing::TestWithParam<Case> {};

TEST_P(PclRegistrationTest, FollowsAWalkFromEachGuess) {
  EXPECT_LT(largest_error(run(GetParam().make, short_walk()), short_walk()), 0.06);
  const Options constant_velocity{PclGuess::constant_velocity};
  EXPECT_LT(largest_error(run(GetParam().make, short_walk(), constant_velocity), short_walk()), 0.06);
  // Where scans are deskewed by what was predicted, gait shows.
  const Options alone{.odometry = false};
  EXPECT_LT(largest_error(run(GetParam().make, short_walk(), alone), short_walk()), 0.2);
}

TEST_P(PclRegistrationTest, OdometryIsAGuessAndNoPrior) {
  synthetic::WalkConfig config;
  config.duration_s = 4.0;
  config.odometry_scale = 1.3;
  const synthetic::Recording recording =
      synthetic::walk(synthetic::corridor_house(), synthetic::corridor_house_walk(), config);
  EXPECT_LT(largest_error(run(GetParam().make, recording), recording), 0.06);
}

TEST_P(PclRegistrationTest, SaysLostWhenItsEyesAreElsewhere) {
  synthetic::Recording recording = short_walk();
  const std::size_t from = 2 * recording.scans.size() / 3;
  const Nanoseconds stamp = recording.scans[from].stamp;
  Pose X_OR;
  for (Odometry& odometry : recording.odometry) {
    if (odometry.stamp < stamp) X_OR = odometry.X_OR;
    odometry.X_OR = odometry.stamp < stamp ? odometry.X_OR : X_OR;
  }
  const Scan elsewhere =
      synthetic::standing_scan(synthetic::one_room(3.0, 2.0), Pose::from_xyz_yaw({0.8, 0.7, 0.46}, 1.0), {});
  for (std::size_t k = from; k < recording.scans.size(); ++k) {
    const Nanoseconds at = recording.scans[k].stamp;
    recording.scans[k] = elsewhere;
    recording.scans[k].stamp = at;
  }
  const std::vector<Output> outputs = run(GetParam().make, recording);
  for (std::size_t k = 0; k < from; ++k) EXPECT_EQ(outputs[k].state, State::converged) << k;
  EXPECT_TRUE(std::any_of(outputs.begin(), outputs.end(), [](const Output& o) { return o.state == State::lost; }));
}

TEST_P(PclRegistrationTest, BlindAndSpoiledScansLeaveAFinitePose) {
  synthetic::Recording recording = short_walk();
  const auto blind = [](Scan& scan) { std::fill(scan.range_m.begin(), scan.range_m.end(), 0.0); };
  for (std::size_t k = 0; k < 3; ++k) blind(recording.scans[k]);
  for (std::size_t k = 20; k < 24; ++k) blind(recording.scans[k]);
  const Nanoseconds stamp = recording.scans[26].stamp;
  recording.scans[26] = Scan{};
  recording.scans[26].stamp = stamp;
  for (std::size_t i = 0; i < recording.scans[28].size(); i += 3)
    recording.scans[28].point_L[i].x() = std::numeric_limits<double>::quiet_NaN();
  recording.scans[30] = recording.scans[29];
  const std::vector<Output> outputs = run(GetParam().make, recording);
  for (const Output& output : outputs) {
    ASSERT_TRUE(output.X_FR.has_value());
    EXPECT_TRUE(output.X_FR->t.allFinite() && output.X_FR->q.coeffs().allFinite());
    EXPECT_LT(output.X_FR->t.norm(), 20.0);
  }
  EXPECT_EQ(outputs[23].state, State::lost);
  EXPECT_EQ(outputs.back().state, State::converged);
}

TEST_P(PclRegistrationTest, DoesNotDependOnOdometrysFrame) {
  synthetic::Recording moved = short_walk();
  const Pose X_PO = Pose::from_xyz_yaw({600.0, -800.0, 0.0}, 0.65);
  for (Odometry& odometry : moved.odometry) odometry.X_OR = X_PO * odometry.X_OR;
  const std::vector<Output> here = run(GetParam().make, short_walk()), there = run(GetParam().make, moved);
  for (std::size_t k = 0; k < here.size(); ++k) {
    const Pose error = here[k].X_FR->inverse() * *there[k].X_FR;
    EXPECT_LT(error.t.norm(), 1e-3) << k;
    EXPECT_LT(log_so3(error.q).norm(), 1.7e-4) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Pcl, PclRegistrationTest, testing::Values(Case{"gicp", make_gicp}, Case{"ndt", make_ndt}),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace plumbline::slam
