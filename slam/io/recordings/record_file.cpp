// SPDX-License-Identifier: Apache-2.0
#include "slam/io/recordings/record_file.h"

#include <array>
#include <cmath>
#include <span>

#include "bim/config/tree.h"
#include "slam/io/recordings/tum.h"

namespace plumbline::slam {

namespace {

std::string exact(double value) { return value == 0.0 && std::signbit(value) ? "-0" : format_number(value); }

void check_order(bool& any, Nanoseconds& last, Nanoseconds stamp, const Mark& mark) {
  if (any && stamp <= last) throw InputError(mark, "stamps must increase from line to line");
  any = true;
  last = stamp;
}

/// The next line below the header, which the first one must be.
bool next_row(LineReader& lines, std::string_view header, bool& header_read, std::string& line) {
  if (!lines.next(line)) return false;
  if (header_read) return true;
  if (line != header) throw InputError(lines.mark(), "the first line must be '" + std::string(header) + "'");
  header_read = true;
  return lines.next(line);
}

/// A stamp and as many numbers as there is room for.
void parse_row(std::string_view line, std::string_view header, const Mark& mark, Nanoseconds& stamp,
               std::span<double> values) {
  std::string_view rest = line;
  std::size_t columns = 0;
  bool good = true;
  while (good && columns < values.size() + 2) {
    const std::string_view text = rest.substr(0, rest.find(','));
    if (columns == 0) good = parse_stamp(text, stamp);
    if (columns > 0 && columns <= values.size()) good = parse_number(text, values[columns - 1]);
    ++columns;
    if (text.size() == rest.size()) break;
    rest.remove_prefix(text.size() + 1);
  }
  if (!good || columns != values.size() + 1)
    throw InputError(
        mark, "not " + std::to_string(values.size() + 1) + " numbers with commas between them: " + std::string(header));
}

}  // namespace

LineReader::LineReader(const std::string& path) : path_(path), file_(open_input_file(path)) {}

bool LineReader::next(std::string& line) {
  constexpr std::size_t longest = 4095;
  for (int c = 0; c != EOF;) {
    line.clear();
    while ((c = ::getc_unlocked(file_.stream.get())) != EOF && c != '\n' && line.size() <= longest)
      line += static_cast<char>(c);
    if (c == EOF && line.empty()) break;
    ++number_;
    if (line.size() > longest)
      throw InputError(mark(), "a line of more than 4095 characters; this is no text file of records");
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (!line.empty() && line.front() != '#') return true;
  }
  if (std::ferror(file_.stream.get()) != 0) throw InputError({path_, 0, 0}, "cannot be read");
  return false;
}

bool OdometryReader::next(Odometry& record) {
  std::string line;
  if (!lines_.next(line)) return false;
  const StampedPose pose = parse_tum_line(line, lines_.mark());
  check_order(any_, last_, pose.stamp, lines_.mark());
  record = {pose.stamp, pose.X_FR};
  return true;
}

bool CovarianceReader::next(OdometryCovariance& record) {
  std::string line;
  if (!next_row(lines_, covariance_header, header_, line)) return false;
  std::array<double, 21> v{};
  parse_row(line, covariance_header, lines_.mark(), record.stamp, v);
  check_order(any_, last_, record.stamp, lines_.mark());
  Matrix6d m;
  std::size_t k = 0;
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) m(i, j) = m(j, i) = v[k++];
  if (!(m.diagonal().minCoeff() >= 0.0)) throw InputError(lines_.mark(), "a variance below 0");
  record.covariance = m;
  return true;
}

bool ImuReader::next(Imu& record) {
  std::string line;
  if (!next_row(lines_, imu_header, header_, line)) return false;
  std::array<double, 6> v{};
  parse_row(line, imu_header, lines_.mark(), record.stamp, v);
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

std::string covariance_line(const OdometryCovariance& record) {
  const Matrix6d& m = record.covariance;
  std::string line = format_stamp(record.stamp);
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) line += "," + exact(m(i, j));
  return line + "\n";
}

std::string imu_line(const Imu& record) {
  std::string line = format_stamp(record.stamp);
  for (const double v : record.angular_velocity_R) line += "," + exact(v);
  for (const double v : record.linear_acceleration_R) line += "," + exact(v);
  return line + "\n";
}

}  // namespace plumbline::slam
