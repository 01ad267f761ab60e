// SPDX-License-Identifier: Apache-2.0
#include "slam/io/recordings/tum.h"

#include <array>
#include <charconv>
#include <cmath>

#include "bim/config/tree.h"
#include "bim/config/utf8.h"
#include "bim/config/words.h"
#include "slam/io/pose_check.h"
#include "slam/io/second.h"

namespace plumbline::slam {

bool parse_number(std::string_view text, double& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
}

// Plain decimals without a detour through double; other notations through one.
bool parse_stamp(std::string_view text, Nanoseconds& stamp) {
  double value = 0.0;
  if (!parse_number(text, value) || std::abs(value) * 1e9 >= static_cast<double>(furthest_stamp)) return false;
  const std::size_t dot = text.find('.');
  if (text.find_first_of("eE-") != std::string_view::npos || dot == std::string_view::npos) {
    stamp = static_cast<Nanoseconds>(std::llround(value * 1e9));
    return true;
  }
  std::int64_t whole = 0;
  std::from_chars(text.data(), text.data() + dot, whole);
  std::int64_t fraction = 0;
  std::int64_t unit = second_ns / 10;
  for (std::size_t i = dot + 1; i < text.size() && unit > 0; ++i, unit /= 10) fraction += (text[i] - '0') * unit;
  stamp = whole * second_ns + fraction;
  return true;
}

StampedPose parse_tum_line(std::string_view line, const Mark& mark) {
  const std::vector<std::string_view> columns = split_words(line);
  if (columns.size() != 8)
    throw InputError(mark, std::to_string(columns.size()) + " columns; a TUM line has 8: t tx ty tz qx qy qz qw");
  StampedPose pose;
  std::array<double, 7> v{};
  double time = 0.0;
  bool good = parse_number(columns[0], time);
  if (good && !parse_stamp(columns[0], pose.stamp))
    throw InputError(mark, "'" + std::string(columns[0]) + "' is no time in seconds; is it in nanoseconds?");
  for (std::size_t i = 0; i < v.size(); ++i) good = parse_number(columns[i + 1], v[i]) && good;
  if (!good) throw InputError(mark, "not a number; a TUM line has 8 numbers: t tx ty tz qx qy qz qw");
  pose.X_FR = checked_pose({v[0], v[1], v[2]}, {v[6], v[3], v[4], v[5]}, mark);
  return pose;
}

std::string format_stamp(Nanoseconds stamp) {
  const std::int64_t magnitude = stamp < 0 ? -stamp : stamp;
  std::string fraction = std::to_string(magnitude % second_ns);
  fraction.insert(0, 9 - fraction.size(), '0');
  return (stamp < 0 ? "-" : "") + std::to_string(magnitude / second_ns) + "." + fraction;
}

std::string write_tum(const std::vector<StampedPose>& poses) {
  std::string text;
  for (const StampedPose& pose : poses) {
    text += format_stamp(pose.stamp);
    const Eigen::Quaterniond& q = pose.X_FR.q;
    const Eigen::Vector3d& t = pose.X_FR.t;
    for (const double v : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) text += " " + format_number(v);
    text += "\n";
  }
  return text;
}

std::vector<StampedPose> read_tum(std::string_view text, const std::string& file) {
  std::vector<StampedPose> poses;
  text = without_byte_order_mark(text);
  int line_number = 0;
  while (!text.empty()) {
    ++line_number;
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.empty() || line.front() == '#' || split_words(line).empty()) continue;
    const Mark mark{file, line_number, 1};
    poses.push_back(parse_tum_line(line, mark));
    if (poses.size() > 1 && poses.back().stamp <= poses[poses.size() - 2].stamp)
      throw InputError(mark, "stamps must increase from line to line");
  }
  return poses;
}

}  // namespace plumbline::slam
