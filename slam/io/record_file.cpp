// SPDX-License-Identifier: Apache-2.0
#include "slam/io/record_file.h"

#include <array>
#include <cmath>

#include "bim/config/tree.h"
#include "slam/io/tum.h"

namespace plumbline::slam {

namespace {

std::string exact(double value) { return value == 0.0 && std::signbit(value) ? "-0" : format_number(value); }

void check_order(bool& any, Nanoseconds& last, Nanoseconds stamp, const Mark& mark) {
  if (any && stamp <= last) throw InputError(mark, "stamps must increase from line to line");
  any = true;
  last = stamp;
}

}  // namespace

LineReader::LineReader(const std::string& path) : path_(path), stream_(path) {
  if (!stream_) throw InputError({path, 0, 0}, "cannot be opened");
}

bool LineReader::next(std::string& line) {
  std::array<char, 4096> buffer{};
  while (stream_.getline(buffer.data(), buffer.size())) {
    ++number_;
    const auto length = static_cast<std::size_t>(stream_.gcount());
    line.assign(buffer.data(), stream_.eof() ? length : length - 1);
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (!line.empty() && line.front() != '#') return true;
  }
  if (stream_.bad()) throw InputError({path_, 0, 0}, "cannot be read");
  if (stream_.eof()) return false;
  ++number_;
  throw InputError(mark(), "a line of more than 4095 characters; this is no text file of records");
}

bool OdometryReader::next(Odometry& record) {
  std::string line;
  if (!lines_.next(line)) return false;
  const StampedPose pose = parse_tum_line(line, lines_.mark());
  check_order(any_, last_, pose.stamp, lines_.mark());
  record = {pose.stamp, pose.X_FR};
  return true;
}

bool ImuReader::next(Imu& record) {
  std::string line;
  if (!lines_.next(line)) return false;
  if (!header_ && line != imu_header)
    throw InputError(lines_.mark(), "the first line must be '" + std::string(imu_header) + "'");
  if (!header_ && !lines_.next(line)) return false;
  header_ = true;
  std::array<double, 6> v{};
  std::string_view rest = line;
  std::size_t columns = 0;
  bool good = true;
  while (good && columns < 8) {
    const std::string_view text = rest.substr(0, rest.find(','));
    if (columns == 0) good = parse_stamp(text, record.stamp);
    if (columns > 0 && columns < 7) good = parse_number(text, v[columns - 1]);
    ++columns;
    if (text.size() == rest.size()) break;
    rest.remove_prefix(text.size() + 1);
  }
  if (!good || columns != 7)
    throw InputError(lines_.mark(), "not 7 numbers with commas between them: " + std::string(imu_header));
  check_order(any_, last_, record.stamp, lines_.mark());
  record.angular_velocity_R = {v[0], v[1], v[2]};
  record.linear_acceleration_R = {v[3], v[4], v[5]};
  return true;
}

std::string odometry_line(const Odometry& record) {
  const Eigen::Quaterniond& q = record.X_OR.q;
  const Eigen::Vector3d& t = record.X_OR.t;
  std::string line = format_stamp(record.stamp);
  for (const double v : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) line += " " + exact(v);
  return line + "\n";
}

std::string imu_line(const Imu& record) {
  std::string line = format_stamp(record.stamp);
  for (const double v : record.angular_velocity_R) line += "," + exact(v);
  for (const double v : record.linear_acceleration_R) line += "," + exact(v);
  return line + "\n";
}

}  // namespace plumbline::slam
