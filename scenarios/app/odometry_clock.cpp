// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/odometry_clock.h"

#include <algorithm>
#include <cmath>

#include "bim/geometry/pose.h"
#include "scenarios/report/svg.h"
#include "slam/odometry/clock_offset.h"

namespace plumbline::scenarios {

namespace {

constexpr slam::Nanoseconds step = 50'000'000;
constexpr std::ptrdiff_t most_steps = 20;             // of lag, either way
constexpr slam::Nanoseconds longest = 1'000'000'000;  // a gap is no turn

/// Sum of products of a[i + lag] and b[i] over that of squares, where both are.
double correlation(const std::vector<double>& a, const std::vector<double>& b, std::ptrdiff_t lag) {
  double product = 0.0, squares_a = 0.0, squares_b = 0.0;
  for (std::ptrdiff_t i = 0; i < static_cast<std::ptrdiff_t>(b.size()); ++i) {
    if (i + lag < 0 || i + lag >= static_cast<std::ptrdiff_t>(a.size())) continue;
    const double x = a[static_cast<std::size_t>(i + lag)], y = b[static_cast<std::size_t>(i)];
    product += x * y;
    squares_a += x * x;
    squares_b += y * y;
  }
  return squares_a > 0.0 && squares_b > 0.0 ? product / std::sqrt(squares_a * squares_b) : 0.0;
}

}  // namespace

void OdometryClock::Turns::add(slam::Nanoseconds first, slam::Nanoseconds stamp, double turn) {
  constexpr std::size_t most = 2'000'000;  // 28 hours
  const slam::Nanoseconds from = last.value_or(stamp);
  last = stamp;
  if (from < first || stamp <= from || stamp - from > longest) return;
  const auto end = static_cast<std::size_t>((stamp - first) / step);
  if (end >= most) return;
  if (by_step.size() <= end) by_step.resize(end + 1, 0.0);
  for (slam::Nanoseconds t = from; t < stamp;) {
    const slam::Nanoseconds next = std::min(stamp, ((t - first) / step + 1) * step + first);
    by_step[static_cast<std::size_t>((t - first) / step)] +=
        turn * static_cast<double>(next - t) / static_cast<double>(stamp - from);
    t = next;
  }
}

void OdometryClock::add(const slam::SensorFrame& frame) {
  if (!first_ && (frame.odometry.empty() || frame.imu.empty())) return;
  if (!first_) first_ = std::max(frame.odometry.front().stamp, frame.imu.front().stamp);
  for (const slam::Odometry& odometry : frame.odometry) {
    const double turn = odometry_ ? log_so3(odometry_->X_OR.q.inverse() * odometry.X_OR.q).z() : 0.0;
    by_odometry_.add(*first_, odometry.stamp, turn);
    odometry_ = odometry;
  }
  for (const slam::Imu& imu : frame.imu) {
    const double dt_s = by_gyro_.last ? slam::seconds(imu.stamp - *by_gyro_.last) : 0.0;
    by_gyro_.add(*first_, imu.stamp, imu.angular_velocity_R.z() * dt_s);
  }
}

std::optional<double> OdometryClock::lag_s() const {
  constexpr double least_turned = 2.0, alike = 0.8;  // rad; correlation
  const auto turned = [](const Turns& turns) {
    double sum = 0.0;
    for (const double turn : turns.by_step) sum += std::abs(turn);
    return sum;
  };
  if (turned(by_odometry_) < least_turned || turned(by_gyro_) < least_turned) return std::nullopt;
  std::vector<double> by_lag;
  for (std::ptrdiff_t lag = -most_steps; lag <= most_steps; ++lag)
    by_lag.push_back(correlation(by_odometry_.by_step, by_gyro_.by_step, lag));
  const auto best = static_cast<std::size_t>(std::max_element(by_lag.begin(), by_lag.end()) - by_lag.begin());
  if (by_lag[best] < alike || best == 0 || best + 1 == by_lag.size()) return std::nullopt;
  const double below = by_lag[best - 1], above = by_lag[best + 1], curve = below - 2.0 * by_lag[best] + above;
  const double part = curve < 0.0 ? 0.5 * (below - above) / curve : 0.0;  // vertex of the parabola through three
  return (static_cast<double>(best) - static_cast<double>(most_steps) + part) * slam::seconds(step);
}

std::optional<std::string> OdometryClock::warning() const {
  constexpr double large_s = 0.08;  // assumed; 5 cm at a walk
  const std::optional<double> lag = lag_s();
  if (!lag || std::abs(*lag) < large_s) return std::nullopt;
  return "odometry is stamped " + svg::number(std::abs(*lag), 2) + " s " + (*lag > 0.0 ? "later" : "earlier") +
         " than the IMU turns: one of the two has another clock, or its driver stamps it late. Our methods find up "
         "to " +
         svg::number(slam::seconds(slam::ClockOffset::largest), 2) + " s between odometry and scans by themselves";
}

}  // namespace plumbline::scenarios
