// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/odometry_axes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bim/config/tree.h"
#include "bim/geometry/pose.h"
#include "bim/median.h"

namespace plumbline::scenarios {

/// About R's z axis, since the frame before.
double OdometryAxes::gyro_turn_of(const slam::SensorFrame& frame) {
  constexpr double longest_s = 0.1;  // a gap is no turn
  double turn = 0.0;
  for (const slam::Imu& imu : frame.imu) {
    const double dt = last_imu_ ? slam::seconds(imu.stamp - *last_imu_) : 0.0;
    turn += imu.angular_velocity_R.z() * std::min(dt, longest_s);
    last_imu_ = imu.stamp;
  }
  return turn;
}

void OdometryAxes::add_speed_and_standstill(const slam::Odometry& newest, double gyro_turn) {
  const double dt = last_ ? slam::seconds(newest.stamp - last_->stamp) : 0.0;
  if (dt <= 0.0) return;
  const Pose& before = last_->X_OR;
  if (const double way_m = (newest.X_OR.t - before.t).norm(); way_m > 0.0) speeds_mps_.push_back(way_m / dt);
  const bool same = newest.X_OR.t == before.t && newest.X_OR.q.coeffs() == before.q.coeffs();
  still_s_ = same ? still_s_ + dt : 0.0;
  constexpr double turns_radps = 0.1, clearly_turned = 0.5;  // beyond a gyro's noise and bias
  const double turn = std::abs(gyro_turn) > turns_radps * dt ? std::abs(gyro_turn) : 0.0;
  still_turn_ = same ? still_turn_ + turn : 0.0;
  if (still_turn_ < clearly_turned || still_s_ <= longest_still_s_) return;
  longest_still_s_ = still_s_;
  longest_still_end_s_ = slam::seconds(newest.stamp - first_stamp_.value_or(newest.stamp));
}

void OdometryAxes::add(const slam::SensorFrame& frame) {
  const double gyro = gyro_turn_of(frame);
  if (frame.odometry.empty()) return;
  const slam::Odometry& newest = frame.odometry.back();
  if (!first_stamp_) first_stamp_ = frame.odometry.front().stamp;
  if (!start_tilt_deg_) {
    const double up = (frame.odometry.front().X_OR.q * Eigen::Vector3d::UnitZ()).z();
    start_tilt_deg_ = 180.0 / std::numbers::pi * std::acos(std::clamp(up, -1.0, 1.0));
  }
  if (last_ && !frame.imu.empty()) {
    const double turn = log_so3(last_->X_OR.q.inverse() * newest.X_OR.q).z();
    turned_ += std::abs(turn);
    product_ += turn * gyro;
    odometry_squares_ += turn * turn;
    gyro_squares_ += gyro * gyro;
  }
  add_speed_and_standstill(newest, gyro);
  last_ = newest;
}

std::vector<std::string> OdometryAxes::warnings() const {
  constexpr double most_tilt_deg = 60.0;                 // no robot on a floor starts so
  constexpr double least_turned = 1.0, opposite = -0.5;  // rad; correlation
  std::vector<std::string> all;
  if (start_tilt_deg_.value_or(0.0) > most_tilt_deg)
    all.push_back("odometry starts with the robot tilted by " + format_number(std::round(*start_tilt_deg_)) +
                  " degrees: in one of its two frames z does not point up, which methods rely on");
  if (turned_ > least_turned && product_ < opposite * std::sqrt(odometry_squares_ * gyro_squares_))
    all.push_back(
        "odometry turns against the gyro: one of the two is in other axes than its frame says, "
        "such as NED or left-handed ones");
  constexpr double fast_mps = 60.0;  // 216 km/h: no vehicle with odometry
  if (const double usual = speeds_mps_.empty() ? 0.0 : upper_median(speeds_mps_); usual > fast_mps)
    all.push_back("odometry moves at " + format_number(std::round(usual)) +
                  " m/s: its positions seem to be in centimetres or millimetres, and metres are meant");
  constexpr double stopped_s = 2.0;
  if (longest_still_s_ > stopped_s)
    all.push_back("odometry does not change for " + format_number(std::round(longest_still_s_)) + " s, to " +
                  format_number(std::round(longest_still_end_s_)) +
                  " s after its first record, while the gyro turns: it seems to have stopped");
  constexpr double degree = 180.0 / std::numbers::pi, within = 1.25, together = 0.5;
  const double ratio = odometry_squares_ > 0.0 ? product_ / odometry_squares_ : 0.0;
  if (turned_ > least_turned && product_ > together * std::sqrt(odometry_squares_ * gyro_squares_) &&
      ratio > degree / within && ratio < degree * within)
    all.push_back("the gyro turns " + format_number(std::round(ratio)) +
                  " times as fast as odometry: it seems to be in degrees per second, and radians are meant");
  return all;
}

}  // namespace plumbline::scenarios
