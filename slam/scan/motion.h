// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <vector>

#include "slam/io/records.h"

namespace plumbline::slam {

/// Recent odometry, interpolated for the robot's motion between scan times.
class MotionBuffer {
 public:
  /// Farther than a robot goes between two records: the odometry has jumped. Its frame is then moved along, so that the
  /// robot keeps position and heading over the jump; only increments and tilt mean anything.
  static constexpr double max_speed_mps = 60.0;
  static constexpr double max_turn_radps = 60.0;
  /// Age of the newest record from which the odometry counts as stale: one and a half of its periods, and between one
  /// and a half periods of 10 and of 2 Hz.
  static constexpr Nanoseconds least_max_age = 150'000'000, most_max_age = 750'000'000;

  /// Records come in time order, else InternalError; one with the newest stamp replaces it, one that is not finite is
  /// left out.
  void add(const Odometry& odometry);
  /// X_OR at time t, interpolated. After the newest record the last velocity goes on until the odometry is stale: a
  /// scan ends between two records. Before the oldest it is the oldest pose. Needs at least one record, else
  /// InternalError.
  [[nodiscard]] Pose at(Nanoseconds t) const;
  [[nodiscard]] bool empty() const { return records_.empty(); }
  /// True when the newest record is older than max_age() at time t, so that at(t) does not give the motion since.
  [[nodiscard]] bool is_stale_at(Nanoseconds t) const { return records_.empty() || age_at(t) > max_age(); }
  /// Time from the newest record to t, over which at(t) extrapolates; 0 where there is one at or after t.
  [[nodiscard]] Nanoseconds age_at(Nanoseconds t) const {
    return records_.empty() ? 0 : std::max<Nanoseconds>(t + clock_offset_ - records_.back().stamp, 0);
  }
  [[nodiscard]] Nanoseconds max_age() const;
  /// Longest time without a record between two times, of what lies between records.
  [[nodiscard]] Nanoseconds longest_gap(Nanoseconds from, Nanoseconds to) const;
  /// Time between the two newest records, 0 before the second. Where stamps are uneven, the second largest of a
  /// second: bursts leave gaps again and again, a lost record one.
  [[nodiscard]] Nanoseconds period() const { return usual_.period; }
  /// Drops what is not needed for times from t on. A second before the newest record is kept.
  void forget_before(Nanoseconds t);
  /// From now on the records' stamps count as `offset` late. The robot keeps its pose at time t, as over a jump.
  void set_clock_offset(Nanoseconds offset, Nanoseconds t);

 private:
  static constexpr Nanoseconds window = 1'000'000'000;
  /// Of the records of a window.
  struct Usual {
    double mean_ns = 0.0;           ///< interval
    bool even = true;               ///< all intervals are about the mean, and none of a burst
    std::size_t velocity_from = 0;  ///< the record since which the newest one's velocity is taken: the one before it,
                                    ///< or where stamps are uneven one that is ten intervals older
    Nanoseconds period = 0;
  };
  [[nodiscard]] Usual usual() const;
  [[nodiscard]] bool is_jump(const Odometry& from, const Odometry& to) const;

  std::deque<Odometry> records_;
  Usual usual_;
  Nanoseconds clock_offset_ = 0;
  std::optional<Pose> frame_shift_;  ///< of the odometry's frame, since a jump
};

/// Frame B of an odometry in its frame O from where it is X_BR in the one and X_OR in the other: by position and
/// heading, since z is up in both and the robot's tilt is its own.
[[nodiscard]] Pose join_frames(const Pose& X_OR, const Pose& X_BR);

/// What is known of a scan's pose before it is matched.
struct OdometrySample {
  Pose step;             ///< of R since the scan before: where a search starts
  bool valid = true;     ///< false: nothing measured the step
  double sigma_m = 0.1;  ///< of the step in directions that surfaces leave open
  /// From it, of a step that a scan may be matched at which does not fit where a search starts.
  double farthest_m = std::numeric_limits<double>::infinity();
  double farthest_rad = std::numeric_limits<double>::infinity();
  double extrapolated_m = 0.0;             ///< standard deviations of what odometry's records do not reach ...
  double extrapolated_rad = 0.0;           ///< ... at either end of the step
  std::optional<Eigen::Quaterniond> q_OR;  ///< R's attitude in a frame whose z is up, where odometry tells it
};

/// Standard deviation of a motion, 0 where it was measured as it was made.
struct TwistSigma {
  double mps = 0.0;
  double radps = 0.0;
  double least_bend_m = 0.0;  ///< by which it moves what a scan sees, from the first return to the last, to count
};

/// A scan with every return moved to R at scan.stamp. Index of a return: column * rings + ring; rings are in line, that
/// is, returns of a column have one azimuth also where lasers of one firing point to different sides (VLP-32C).
struct DeskewedScan {
  Nanoseconds stamp = 0;
  int rings = 16;
  int columns = 0;
  std::vector<double> range_m;           ///< as measured; 0: no return, or one that is no finite point in its range
  std::vector<Eigen::Vector3d> point_R;  ///< at stamp; zero where there is no return
  Pose X_RL;                             ///< sensor in R
  bool odometry_stale = false;           ///< at stamp: nothing is known of the motion since its last record
  Nanoseconds odometry_age = 0;          ///< at stamp, of its last record: the motion since is extrapolated
  std::vector<double> elevation;         ///< of a return in L as measured, rad; empty where the scan has rings
  std::vector<float> time_s;             ///< of a return after stamp, 0 or less; empty where returns have no times
  TwistSigma twist_sigma;                ///< of the motion during the scan that was undone
};

/// Coordinates in R of the returns of these ranges, in the scan's order.
[[nodiscard]] std::vector<Eigen::Vector3d> points_between(const DeskewedScan& scan, double min_range_m,
                                                          double max_range_m);

/// Coordinates of these returns in R, side by side; a scan stores those of a ring far apart.
[[nodiscard]] std::vector<Eigen::Vector3d> points_of(const DeskewedScan& scan,
                                                     const std::vector<std::uint32_t>& returns);

/// False: points in the order of a file, not of lasers.
[[nodiscard]] inline bool has_rings(const Scan& scan) { return scan.rings >= 4; }
[[nodiscard]] inline bool has_rings(const DeskewedScan& scan) { return scan.rings >= 4; }

/// Angle above the horizontal of L, rad.
[[nodiscard]] inline double elevation(const Eigen::Vector3d& p_L) { return std::atan2(p_L.z(), p_L.head<2>().norm()); }

/// The same scan where the robot's motion during it was off by `twist` per second, (rho, phi) in R.
void correct_motion(DeskewedScan& scan, const Vector6d& twist);

/// Undoes the robot's motion during the scan by the odometry's relative poses: one for all returns of a column that are
/// measured within 0.1 ms, in which even a car moves 3 mm. Putting rings in line drops at either end of the scan the
/// few columns that some rings do not have; a message's overlap is as wide.
[[nodiscard]] DeskewedScan deskew(const Scan& scan, const MotionBuffer& motion, const Calibration& calibration);

/// The same of a scan that comes deskewed: its returns are all of its stamp. Says nothing of odometry.
[[nodiscard]] DeskewedScan as_deskewed(const Scan& scan, const Calibration& calibration);

/// Of every eighth column's points; what differs elsewhere shows in the stages behind.
[[nodiscard]] std::uint64_t digest(const DeskewedScan& scan);

}  // namespace plumbline::slam
