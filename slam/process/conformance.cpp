// SPDX-License-Identifier: Apache-2.0
#include "slam/process/conformance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <optional>
#include <span>
#include <string_view>

#include "bim/digest/digest.h"
#include "slam/io/stopwatch.h"
#include "slam/process/child.h"
#include "slam/process/trial_walk.h"

namespace plumbline::slam {

namespace {

using Kind = Finding::Kind;

constexpr double near_m = 0.03;  ///< three times the noise of a range
constexpr double far_m = 0.25;   ///< of a walk of 4 m
constexpr double period_ms = 100.0;
constexpr std::size_t without_return = 12, with_one_return = 14;  ///< scans of the poor walk

std::string format(const char* pattern, double a, double b = 0.0) {
  char text[200];
  std::snprintf(text, sizeof text, pattern, a, b);
  return text;
}

/// What a process answered to a walk.
struct Trial {
  std::vector<Output> outputs;
  std::vector<std::uint64_t> answers;  ///< digests of all bytes: one a scan, then of the estimate
  std::vector<double> wall_ms;
  Estimate estimate;
  double start_s = 0.0;
  std::string failure;  ///< empty: it went to the end
};

MethodInput input_of(const TrialWalk& walk, const std::shared_ptr<const bim::Plan>& plan, bool lidar_alone) {
  MethodInput input;
  input.seed = 1;
  input.calibration = walk.calibration;
  input.plan = plan;
  input.has_odometry = !lidar_alone;
  return input;
}

void give(Method& method, const TrialStep& step, bool lidar_alone, Trial& trial) {
  if (!lidar_alone) {
    for (const Imu& imu : step.imu) method.on_imu(imu);
    for (const Odometry& odometry : step.odometry) method.on_odometry(odometry);
  }
  const double before_s = wall_s();
  trial.outputs.push_back(method.on_scan(step.scan));
  trial.wall_ms.push_back(1e3 * (wall_s() - before_s));
}

Trial try_on(ProcessCommand command, const TrialWalk& walk, const MethodInput& input,
             const std::function<void()>& go_on) {
  Trial trial;
  command.answered = [&](std::span<const std::byte> bytes) {
    trial.answers.push_back(
        Digest().add(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size())).value());
  };
  try {
    const double before_s = wall_s();
    const std::unique_ptr<Method> method = make_process_method(command, input);
    trial.start_s = wall_s() - before_s;
    for (const TrialStep& step : walk.steps) {
      go_on();
      give(*method, step, !input.has_odometry, trial);
    }
    trial.estimate = method->finish();
  } catch (const ProcessFailure& failure) {
    trial.failure = failure.what();
  }
  go_on();
  return trial;
}

bool same(const Pose& a, const Pose& b) { return a.t == b.t && a.q.coeffs() == b.q.coeffs(); }

/// Root mean square distance of what f makes of the answers from where `truth` has the robot.
double misfit(const std::vector<StampedPose>& answered, bool aligned, const std::function<Pose(const Pose&)>& f,
              const std::function<Pose(Nanoseconds)>& truth) {
  const Pose X_WF = aligned ? truth(answered.front().stamp) * f(answered.front().X_FR).inverse() : Pose{};
  double sum = 0.0;
  for (const StampedPose& pose : answered) sum += ((X_WF * f(pose.X_FR)).t - truth(pose.stamp).t).squaredNorm();
  return std::sqrt(sum / static_cast<double>(answered.size()));
}

std::vector<StampedPose> poses_of(const Trial& trial) {
  std::vector<StampedPose> poses;
  for (const Output& output : trial.outputs)
    if (output.X_FR) poses.push_back({output.stamp, *output.X_FR});
  return poses;
}

/// The beginning of the walk, with scans in it that a method does not expect.
TrialWalk without_returns(TrialWalk walk) {
  const auto spoil = [](Scan& scan, std::size_t kept) {
    for (std::size_t i = kept; i < scan.size(); ++i) {
      scan.range_m[i] = 0.0;
      scan.point_L[i].setZero();
      scan.reflectivity[i] = 0.0F;
    }
  };
  spoil(walk.steps[without_return].scan, 0);
  spoil(walk.steps[with_one_return].scan, 1);
  walk.steps.resize(20);
  return walk;
}

using Findings = std::function<void(const Finding&)>;

void report_poor(const Trial& poor, const Findings& found) {
  if (poor.failure.empty())
    found({Kind::fine, "takes LiDAR alone, and scans of no and of one return"});
  else if (poor.outputs.size() < without_return)
    found({Kind::note, "does not run on LiDAR alone: " + poor.failure});
  else
    found({Kind::note, std::string("does not take a scan of ") +
                           (poor.outputs.size() == without_return ? "no return" : "one return") +
                           ", which a damaged recording may have: " + poor.failure});
}

void report_speed(const Trial& trial, const Findings& found) {
  double sum = 0.0;
  for (const double ms : trial.wall_ms) sum += ms;
  const double mean = sum / static_cast<double>(trial.wall_ms.size());
  const double most = *std::max_element(trial.wall_ms.begin(), trial.wall_ms.end());
  found({Kind::fine, format("answers a scan in %.1f ms, the slowest in %.1f ms", mean, most)});
  if (mean > period_ms) found({Kind::note, "is slower than the LiDAR, which turns in 100 ms"});
}

void report_estimate(const Trial& trial, const Findings& found) {
  const std::size_t poses = trial.estimate.trajectory.size();
  found({poses > 0 ? Kind::fine : Kind::note, "gives at the end a trajectory of " + std::to_string(poses) +
                                                  " poses and a map of " + std::to_string(trial.estimate.map_F.size()) +
                                                  " points"});
  constexpr double least = 0.95;  // of the scans, as scoring wants it
  if (static_cast<double>(poses) < least * static_cast<double>(trial.outputs.size()))
    found({Kind::note, "gives at the end a pose for " + std::to_string(poses) + " of " +
                           std::to_string(trial.outputs.size()) +
                           " scans; a run has no ate_final_rmse_m of fewer than 95 %"});
  for (const StampedPose& pose : trial.estimate.trajectory)
    if (std::none_of(trial.outputs.begin(), trial.outputs.end(),
                     [&](const Output& output) { return output.stamp == pose.stamp; })) {
      found({Kind::wrong, "gives at the end a pose for " + std::to_string(pose.stamp) +
                              " ns, which is no scan's time; use the stamps of the scans"});
      return;
    }
}

void report_poses(const Trial& trial, const Pose& X_RL, bool localization, const Findings& found) {
  const std::vector<StampedPose> poses = poses_of(trial);
  const std::size_t scans = trial.outputs.size();
  if (poses.empty()) {
    found({localization ? Kind::note : Kind::wrong,
           "gave no pose for any of " + std::to_string(scans) + " scans; a run would count it as lost"});
    return;
  }
  if (poses.size() < scans)
    found({Kind::note, "gave a pose for " + std::to_string(poses.size()) + " of " + std::to_string(scans) + " scans"});
  const auto as_is = [](const Pose& X) { return X; };
  const double rms = misfit(poses, !localization, as_is, trial_pose);
  if (const std::optional<Finding> why = misunderstanding(poses, X_RL, !localization))
    found({why->kind, format("is off by %.3f m, rms, on a walk of 4 m: ", rms) + why->text});
  else
    found({rms < far_m ? Kind::fine : Kind::note,
           format(rms < far_m ? "follows the walk within %.3f m, rms"
                              : "is off by %.3f m, rms, on a walk of 4 m with a good view",
                  rms)});
}

/// Of two trials of the same records, of which the first went to the end.
void report_repetition(const Trial& first, const Trial& second, const Findings& found) {
  const auto [one, other] =
      std::mismatch(first.answers.begin(), first.answers.end(), second.answers.begin(), second.answers.end());
  const auto scan = static_cast<std::size_t>(one - first.answers.begin()) + 1;
  if (!second.failure.empty())
    found({Kind::wrong, "the second time: " + second.failure});
  else if (one != first.answers.end() || other != second.answers.end())
    found({Kind::note,
           "does not repeat: the same records gave another " +
               (scan > first.outputs.size() ? "estimate at the end" : "answer at scan " + std::to_string(scan)) +
               "; replay and repeat: true will say so. Threads, clocks and seeds are the usual "
               "causes"});
  else
    found({Kind::fine, "repeats to the last bit"});
}

/// Of a trial without a plan, what a localization would do.
void report_missing_plan(const Trial& trial, const Findings& found) {
  const bool several = std::any_of(trial.outputs.begin(), trial.outputs.end(),
                                   [](const Output& output) { return !output.hypotheses.empty(); });
  if (several)
    found({Kind::note, "answers with hypotheses, as a localization does; with --plan it gets the plan of the walk"});
  else if (poses_of(trial).empty())
    found({Kind::note, "got no plan; a method that localizes in one is tried with --plan"});
}

}  // namespace

std::optional<Finding> misunderstanding(const std::vector<StampedPose>& answered, const Pose& X_RL, bool aligned) {
  struct Reading {
    Kind kind;
    const char* words;
    std::function<Pose(const Pose&)> f;
    Nanoseconds late = 0;
  };
  const auto as_is = [](const Pose& X) { return X; };
  const auto of_lidar = [&](const Pose& X) { return X_RL * X * X_RL.inverse(); };
  const auto in_metres = [](const Pose& X) { return Pose{X.q, 1e-3 * X.t}; };
  const double plain = misfit(answered, aligned, as_is, trial_pose);
  const auto first = [&](const StampedPose& pose) { return same(pose.X_FR, answered.front().X_FR); };
  if (std::all_of(answered.begin(), answered.end(), first)) return Finding{Kind::wrong, "its pose never changes"};
  constexpr Nanoseconds half_ns = 50'000'000;
  constexpr Kind wrong = Kind::wrong, note = Kind::note;
  const std::vector<Reading> readings = {
      {wrong, "these are poses of the LiDAR in the frame of its first scan; recording.robot_pose() makes the robot's",
       of_lidar},
      {wrong, "these are poses of the LiDAR; multiply them by the inverse of its mount X_RL from the right",
       [&](const Pose& X) { return X * X_RL.inverse(); }},
      {wrong, "these are poses of the map in the robot; give their inverse", [](const Pose& X) { return X.inverse(); }},
      {wrong, "these are poses of the map in the LiDAR; give recording.robot_pose() of their inverse",
       [&](const Pose& X) { return of_lidar(X.inverse()); }},
      {wrong, "these are in millimetres; give metres", in_metres},
      {wrong, "these fit the scan before; answer each scan with its own pose", as_is, 2 * half_ns},
      {note, "these fit the middle of each scan, as without deskewing; a pose belongs to the scan's end", as_is,
       half_ns},
      {wrong,
       "these fit the LiDAR's poses in the middle of each scan; recording.robot_pose() makes the robot's, and a "
       "pose belongs to the scan's end",
       of_lidar, half_ns},
  };
  constexpr double clearly = 0.6;
  double best = std::min(near_m, clearly * plain);
  std::optional<Finding> found;
  for (const Reading& reading : readings) {
    const auto truth = [&](Nanoseconds t) { return trial_pose(t - reading.late); };
    const double off = misfit(answered, aligned, reading.f, truth);
    if (plain <= near_m || off >= best) continue;
    best = off;
    found = Finding{reading.kind, reading.words};
  }
  return found;
}

void check_conformance(ProcessCommand command, const std::shared_ptr<const bim::Plan>& plan, const Findings& found,
                       const std::function<void()>& go_on) {
  command.strict = true;
  command.go_on = go_on;
  const TrialWalk walk = trial_walk();
  const Trial first = try_on(command, walk, input_of(walk, plan, false), go_on);
  const bool started = !first.wall_ms.empty() || first.failure.empty();
  if (started) found({Kind::fine, format("starts and greets in %.2f s", first.start_s)});
  if (!first.failure.empty()) found({Kind::wrong, first.failure});
  if (plan == nullptr) report_missing_plan(first, found);
  if (!started) return;
  report_speed(first, found);
  if (!first.failure.empty()) return;
  report_poses(first, walk.calibration.X_RL, plan != nullptr, found);
  report_estimate(first, found);

  ProcessCommand quiet = command;
  quiet.printed = {};
  const Trial second = try_on(quiet, walk, input_of(walk, plan, false), go_on);
  report_repetition(first, second, found);

  report_poor(try_on(quiet, without_returns(walk), input_of(walk, plan, true), go_on), found);
}

}  // namespace plumbline::slam
