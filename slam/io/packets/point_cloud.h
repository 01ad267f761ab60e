// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "slam/io/records.h"

namespace plumbline::slam {

/// Types of a point's fields, with the numbers that ROS gives them.
enum class PointType : std::uint8_t { i8 = 1, u8, i16, u16, i32, u32, f32, f64 };

struct PointField {
  std::string name;
  std::uint32_t offset = 0;  ///< bytes from the point's start
  PointType type = PointType::f32;
};

/// Points as messages carry them: height rows of width points, little endian.
struct PointCloud {
  Nanoseconds stamp = 0;  ///< of the message; the points' times count from it
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t point_step = 0;  ///< bytes a point
  std::uint32_t row_step = 0;    ///< bytes a row
  bool dense = false;            ///< no point is not-a-number
  std::vector<PointField> fields;
  std::vector<std::uint8_t> data;
};

/// What times of points count from: their cloud's stamp, 0 as that does, or the second in which they were taken.
enum class TimeBase { unknown, stamp, day, second };

/// Finds the time base of a topic's clouds. One alone does not tell while the clock is near 0; over several, times of
/// the day grow with the stamps, and others stay within a sweep. Only f64 can hold times of the day. Whole numbers of
/// 32 bits below 1e9 that grow with the stamps and begin anew with each second are ns within that.
class TimeBaseSearch {
 public:
  /// The next cloud; false once no other is needed. Throws InputError as scan_of() does.
  [[nodiscard]] bool add(const PointCloud& cloud);
  /// From what was added; unknown where it makes no difference, or cannot be told.
  [[nodiscard]] TimeBase base() const;

 private:
  struct Seen {
    Nanoseconds stamp = 0;
    double first_ns = 0.0;  ///< time of the first point, as one of the day
  };
  /// Whole numbers.
  [[nodiscard]] bool add_whole(const PointCloud& cloud, const PointField& time);

  std::optional<TimeBase> found_;
  std::optional<Seen> first_, last_;
  int whole_ = 0;                          ///< clouds with times that are whole numbers
  double most_moved_ns_ = 0.0;             ///< of the first points' times against those of the first cloud
  double most_moved_from_stamp_ns_ = 0.0;  ///< the same of their differences to the stamps, within a second
  int without_times_ = 0;                  ///< clouds
};

/// How the times of a topic's points are read.
struct PointTimes {
  TimeBase base = TimeBase::unknown;
  double unit_ns = 0.0;  ///< ns that a 1 means, from the stamp; 0: told from each cloud by the field's type
  Nanoseconds end_ns =
      0;                 ///< of most sweeps, from the cloud's stamp; that of one without points cannot be told from it
  bool ignored = false;  ///< clouds are read as if they had none
};

struct AssumedTimes {
  PointTimes times;
  std::string said;      ///< what was assumed of the unit, or does not fit; empty where sweeps are as long as can be
  bool readable = true;  ///< those of all clouds that were looked at
};

/// Holds the length of a topic's sweeps against the spacing of its clouds. Where that is impossible, longer than 1.5
/// times the spacing or shorter than 2 ms, times from 0 to 1 are shares of the spacing, and others are in the unit that
/// makes sweeps 5 ms to 1.3 times the spacing long.
class SweepLengthSearch {
 public:
  explicit SweepLengthSearch(TimeBase base) : base_(base) {}
  /// The next cloud; false once no other is needed. Throws InputError as scan_of() does.
  [[nodiscard]] bool add(const PointCloud& cloud);
  [[nodiscard]] AssumedTimes found() const;

 private:
  /// Without the end of a sweep.
  [[nodiscard]] AssumedTimes unit_found() const;

  TimeBase base_;
  std::optional<Nanoseconds> last_stamp_;
  std::vector<double> spacings_ns_;
  std::vector<double> lengths_ns_;  ///< as read without knowing the spacing
  std::vector<double> spans_;       ///< in the field's own unit
  std::vector<double> ends_ns_;     ///< as read without knowing the spacing, from the stamp
  std::vector<double> ends_;        ///< in the field's own unit
  bool shares_ = true;              ///< all go from 0 to 1, or from -1 to 0
  bool from_stamp_ = true;          ///< no times of the day
  bool readable_ = true;            ///< of all clouds so far
  double unit_ns_ = 0.0;            ///< of the last cloud's times, where they are neither s nor whole numbers; else 0
  int without_times_ = 0;           ///< clouds
  std::string unread_;              ///< fields that may be times, of a cloud without others
};

/// What a cloud is written as.
enum class CloudLayout {
  organised,  ///< a row a firing, sorted by ring, not-a-number where there is no return; `time` f32, s
  dense,      ///< returns only; `t` u32, ns
};

/// The scan's points in L, in the order of time: x, y, z and intensity f32, ring u16 and the time since the first
/// return slot, which is the cloud's stamp.
[[nodiscard]] PointCloud cloud_of(const Scan& scan, CloudLayout layout);

/// A cloud's scan.
struct CloudScan {
  Scan scan;
  bool rings_left_out = false;  ///< the cloud's ring numbers: one for returns of many elevations, or above 127
  bool in_mm = false;           ///< the cloud's coordinates are whole numbers
  bool far = false;             ///< more than half of its points are beyond 500 m
};

/// The scan of a cloud whose fields are found by name and type, as the drivers of Velodyne, Ouster, Hesai, RoboSense
/// and Livox write them: x, y, z in m, as whole numbers of 16 or 32 bits in mm; intensity or reflectivity; ring or
/// channel, unless it is one number for returns of many elevations or not within 0 to 127 (else by the layout of an
/// organised cloud, or by elevation where that is a VLP-16's; else the scan has one ring); t, time, timestamp or
/// time_stamp: whole numbers in ns from the stamp, others in s from it, or as times of the day (f64) in the unit that
/// puts them within 1 s of it, or in a unit by which they are 5 ms to 1 s long; `times` says which, where several may
/// be. Without times all points have the cloud's stamp: whether they are deskewed is not known, and undoing a motion
/// twice is as bad as not at all. Columns are the rows or columns of an organised cloud, else found by time or azimuth;
/// of one ring, a column a point. Points that are not finite, at the origin or beyond 1 km are no returns. Scan::stamp
/// is the time of the last point; a cloud without points is a scan without columns at the cloud's. Throws InputError
/// without a mark on a cloud without fields, of wrong size or with times over more than 1 s.
[[nodiscard]] CloudScan read_scan(const PointCloud& cloud, const PointTimes& times = {});
[[nodiscard]] inline Scan scan_of(const PointCloud& cloud, const PointTimes& times = {}) {
  return read_scan(cloud, times).scan;
}

/// What to say of scans whose ring numbers are left out.
inline constexpr std::string_view no_ring_numbers =
    "without their ring numbers, which are one for all points or not within 0 to 127";

}  // namespace plumbline::slam
