// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <vector>

#include "slam/io/records.h"

namespace plumbline::slam {

/// By how much later odometry is stamped than scans. A scan alone tells how far the sensor turned since the scan
/// before: its ranges by azimuth move along. Where the robot begins or ends a turn, or sways in its gait, odometry
/// agrees with that at one offset only.
class ClockOffset {
 public:
  static constexpr Nanoseconds most = 450'000'000;     ///< that is tried, either way
  static constexpr Nanoseconds away = 50'000'000;      ///< from the best, to show that it is
  static constexpr Nanoseconds largest = most - away;  ///< that is found
  /// What costs less than it may be wrong: by 11 ms in the middle of a wide hall, elsewhere by 5 ms.
  static constexpr Nanoseconds ignored = 15'000'000;
  static constexpr Nanoseconds candidate = 12'500'000;  ///< between two that are tried

  explicit ClockOffset(const Calibration& calibration);

  /// Both in time order.
  void add(const Odometry& odometry);
  /// Scans whose returns have no times tell nothing, nor do sensors that stand askew.
  void add(const Scan& scan);
  /// Odometry of the time t is stamped t + value(). 0 until it is known to be more than `ignored`. It changes where the
  /// robot goes straight: in a turn, poses that were found by another offset are off.
  [[nodiscard]] Nanoseconds value() const { return value_; }

 private:
  static constexpr std::size_t candidates = 2 * most / candidate + 1;

  struct Place {
    Nanoseconds stamp = 0;
    Eigen::Vector2d t_OL;
    double yaw = 0.0;  ///< of L, unwrapped
  };
  /// Horizontal ranges by azimuth.
  struct Profile {
    Nanoseconds time = 0;          ///< mean of its returns'
    std::vector<double> range_m;   ///< 0: nothing
    std::vector<double> offset_s;  ///< of the returns in a bin, from `time` ...
    Nanoseconds farthest = 0;      ///< ... and at most
  };

  /// Odometry's yaw where the returns of each bin were seen, at each offset that is tried, rad.
  struct Yaws {
    struct Between {
      std::size_t k = 0;  ///< of the grid, at the first candidate
      double part = 0.0;  ///< of the way to the next
    };
    [[nodiscard]] double operator()(std::size_t bin, std::size_t candidate) const {
      const Between& b = at[bin];
      return (1.0 - b.part) * grid[b.k + candidate] + b.part * grid[b.k + candidate + 1];
    }
    std::vector<double> grid;  ///< a candidate apart
    std::vector<Between> at;   ///< index = bin
  };

  [[nodiscard]] Place place_at(Nanoseconds t) const;
  [[nodiscard]] Yaws yaws_of(Nanoseconds time, const std::vector<double>& offset_s) const;
  void use(const Profile& before, const Profile& now);
  /// Sum of squares that is left between turns at an offset, rad^2.
  [[nodiscard]] double left_at(std::size_t candidate) const;
  [[nodiscard]] bool goes_straight() const;
  void decide();

  Calibration calibration_;
  std::deque<Place> places_;
  std::deque<Profile> profiles_;  ///< until odometry of all candidates is there
  // Sums over pairs of scans at each offset, rad^2: of the turn seen and that of odometry.
  double pairs_ = 0.0;
  std::array<double, candidates> seen2_{}, both_{}, told2_{};
  Nanoseconds value_ = 0;
};

}  // namespace plumbline::slam
