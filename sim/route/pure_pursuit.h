// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "bim/random/stream.h"
#include "sim/robot/robot.h"
#include "sim/route/route_progress.h"
#include "sim/route/speed_profile.h"
#include "sim/route/waypoint.h"

namespace plumbline::sim {

/// Pure pursuit [coulter1992], the stuck check, and the jitter that keeps the gait (2.27 Hz) from meeting
/// the LiDAR's 10 Hz sweep at the same phase every time.
struct PurePursuitConfig {
  SpeedConfig speed;
  ProgressConfig progress;
  double reached_m = 0.25;    ///< a waypoint counts as reached
  double passed_m = 0.5;      ///< also one left behind no further to the side than this
  double lookahead_m = 0.6;   ///< at least,
  double lookahead_s = 0.8;   ///< and as far as the robot walks in this time
  double goal_min_m = 0.2;    ///< a goal nearer than this gives way to the waypoint itself
  double yaw_rate_max = 1.0;  ///< rad/s
  double turn_start = 0.8;    ///< rad, heading error that starts a turn in place
  double turn_end = 0.2;      ///< rad
  double turn_gain = 2.5;     ///< 1/s, in place
  double back_after_s = 3.0;  ///< without progress in a turn in place, back to its waypoint; this and the next: assumed
  double back_mps = 0.2;      ///< on the way there
  double back_near_m = 0.08;  ///< the waypoint counts as reached,
  double back_most_s = 8.0;   ///< or is given up after so long
  int back_times = 2;         ///< at most, a segment
  double steer_gain = 2.0;    ///< 1/s, while walking
  double slow_min = 0.25;     ///< share of the speed kept in the sharpest curve
  double slow_angle_gain = 1.5;  ///< speed falls with the cosine of this times the heading error
  double approach_gain = 0.8;    ///< 1/s, speed by distance on the last segment
  double approach_min_mps = 0.15;
  double stairs_aligned = 0.1;     ///< rad, heading error with which a flight is entered,
  double stairs_centred_m = 0.05;  ///< and distance from its line
  double landing_m = 0.05;         ///< a segment over stairs that falls by no more is a landing
  double side_gain = 1.5;          ///< 1/s, sideways back to that line
  double side_mps = 0.2;           ///< highest speed of that
  double reached_height_m = 0.6;   ///< a waypoint of another level is not reached, however near in the plane
  double standing_height_m = 0.5;  ///< of the base above the floor
  double jitter_s = 0.5;           ///< one draw of the jitter
  double speed_jitter = 0.05;      ///< share, uniform to both sides
  double period_jitter = 0.04;     ///< share of the gait period, uniform to both sides
};

/// Path tracker: walks the robot along waypoints, the first of which is the start.
class PurePursuit {
 public:
  PurePursuit(const PurePursuitConfig& config, std::vector<Waypoint> waypoints, Seed seed);

  /// Command for the robot at X_WR; tick counts physics steps of step_s. A zero command when done. Throws
  /// ScenarioFailure "the robot stalled ..." when it does not follow its command.
  [[nodiscard]] Command update(const Pose& X_WR, std::int64_t tick);
  [[nodiscard]] bool done() const { return next_ >= waypoints_.size(); }

 private:
  void skip_reached(const Eigen::Vector3d& p_W);
  [[nodiscard]] bool reached(const Eigen::Vector3d& sole_W) const;
  [[nodiscard]] bool passed(const Eigen::Vector2d& p_W) const;
  void check_progress(const Pose& X_WR, std::int64_t tick);
  /// From the heading of the robot to the commanded one, rad.
  [[nodiscard]] double heading_error(const Pose& X_WR) const;
  [[nodiscard]] Command on_stairs(const Pose& X_WR);
  [[nodiscard]] Command on_level(const Pose& X_WR);
  /// A turn in place begins as far from its waypoint as reached_m, and may meet a wall where there is little room.
  [[nodiscard]] bool goes_back(const Pose& X_WR, double t_s);
  [[nodiscard]] Command to_turning_place(const Pose& X_WR) const;
  [[nodiscard]] Eigen::Vector2d goal(const Eigen::Vector2d& p_W) const;
  [[nodiscard]] double walking_speed(double heading_error, const Eigen::Vector2d& p_W) const;
  [[nodiscard]] Command jittered(Command command, std::int64_t tick) const;

  PurePursuitConfig config_;
  std::vector<Waypoint> waypoints_;
  Stream jitter_;
  std::size_t next_ = 1;
  bool turning_ = false;
  int times_back_ = 0;  ///< on the segment to next_
  double back_until_s_ = 0.0;
  SpeedProfile speeds_;
  Progress progress_;
};

}  // namespace plumbline::sim
