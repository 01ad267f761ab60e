// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bim/config/input_file.h"
#include "bim/errors.h"
#include "slam/io/odometry_covariance.h"

namespace plumbline::slam {

/// Lines of a text file one by one, in bounded memory. Empty lines and those that start with # are left out.
class LineReader {
 public:
  /// Errors as open_input_file().
  explicit LineReader(const std::string& path);
  /// False at the end. Throws InputError on a line of more than 4,095 characters.
  [[nodiscard]] bool next(std::string& line);
  /// Of the last line.
  [[nodiscard]] Mark mark() const { return {path_, number_, 1}; }

 private:
  std::string path_;
  InputFile file_;
  int number_ = 0;
};

/// odometry.tum, record by record.
class OdometryReader {
 public:
  explicit OdometryReader(const std::string& path) : lines_(path) {}
  /// False at the end. Throws InputError at the line that is wrong, also where stamps do not increase.
  [[nodiscard]] bool next(Odometry& record);

 private:
  LineReader lines_;
  bool any_ = false;
  Nanoseconds last_ = 0;
};

/// odometry_covariance.csv (a line a record: its stamp and the upper triangle, row by row), record by record.
class CovarianceReader {
 public:
  explicit CovarianceReader(const std::string& path) : lines_(path) {}
  /// As OdometryReader; a negative variance is wrong, too.
  [[nodiscard]] bool next(OdometryCovariance& record);

 private:
  LineReader lines_;
  bool any_ = false;
  bool header_ = false;
  Nanoseconds last_ = 0;
};

/// imu.csv ("t,wx,wy,wz,ax,ay,az" and a line a record), record by record.
class ImuReader {
 public:
  explicit ImuReader(const std::string& path) : lines_(path) {}
  /// As OdometryReader.
  [[nodiscard]] bool next(Imu& record);

 private:
  LineReader lines_;
  bool any_ = false;
  bool header_ = false;
  Nanoseconds last_ = 0;
};

/// One line of each, numbers to the last bit (also that of a negative zero), with the line break.
[[nodiscard]] std::string odometry_line(const Odometry& record);
[[nodiscard]] std::string covariance_line(const OdometryCovariance& record);
[[nodiscard]] std::string imu_line(const Imu& record);
inline constexpr std::string_view covariance_header =
    "t,xx,xy,xz,xa,xb,xc,yy,yz,ya,yb,yc,zz,za,zb,zc,aa,ab,ac,bb,bc,cc";
inline constexpr std::string_view imu_header = "t,wx,wy,wz,ax,ay,az";

}  // namespace plumbline::slam
