// SPDX-License-Identifier: Apache-2.0
#include "slam/io/recordings/trajectory.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <charconv>

#include "bim/config/utf8.h"
#include "bim/config/words.h"
#include "bim/errors.h"
#include "slam/io/pose_check.h"
#include "slam/io/recordings/tum.h"

namespace plumbline::slam {

namespace {

constexpr std::size_t kitti_columns = 12, euroc_columns = 8;

using Columns = std::vector<std::string_view>;

/// Columns between blanks, or between commas where there are any.
Columns split(std::string_view line) {
  const bool commas = line.find(',') != std::string_view::npos;
  Columns columns;
  for (std::string_view rest = without_blanks(line);; rest = without_blanks(rest)) {
    const std::size_t end = rest.find_first_of(commas ? "," : " \t");
    columns.push_back(without_blanks(rest.substr(0, end)));
    if (end == std::string_view::npos) return columns;
    rest.remove_prefix(end + 1);
  }
}

/// Calls use(line, number) for each line with numbers until it returns false.
template <class Use>
void for_each_line(std::string_view text, const Use& use) {
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    const std::string_view line = without_blanks(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (!line.empty() && line.front() != '#' && !use(line, number)) return;
  }
}

template <std::size_t n>
std::array<double, n> numbers(const Columns& columns, std::size_t first, const Mark& mark) {
  std::array<double, n> values{};
  for (std::size_t i = 0; i < n; ++i)
    if (!parse_number(columns[first + i], values[i]))
      throw InputError(mark, "'" + std::string(columns[first + i].substr(0, 40)) + "' is not a number");
  return values;
}

StampedPose parse_euroc(const Columns& columns, const Mark& mark) {
  if (columns.size() < euroc_columns)
    throw InputError(mark, std::to_string(columns.size()) +
                               " columns between commas; a EuRoC line has 8 or more: t,px,py,pz,qw,qx,qy,qz");
  StampedPose pose;
  const auto [end, error] = std::from_chars(columns[0].data(), columns[0].data() + columns[0].size(), pose.stamp);
  const bool whole = error == std::errc() && end == columns[0].data() + columns[0].size();
  if (!whole || pose.stamp >= furthest_stamp || pose.stamp <= -furthest_stamp)
    throw InputError(mark,
                     "'" + std::string(columns[0].substr(0, 40)) +
                         "' is no time; a EuRoC line begins with whole nanoseconds, and a TUM line has no commas");
  const auto v = numbers<7>(columns, 1, mark);
  pose.X_FR = checked_pose({v[0], v[1], v[2]}, {v[3], v[4], v[5], v[6]}, mark);
  return pose;
}

Pose parse_kitti(const Columns& columns, const Mark& mark) {
  constexpr double tolerance = 0.01;  // that of a quaternion's norm
  if (columns.size() != kitti_columns)
    throw InputError(mark, std::to_string(columns.size()) + " columns; a KITTI line has 12, three rows of a matrix");
  const auto v = numbers<kitti_columns>(columns, 0, mark);
  const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> rows(v.data());
  const Eigen::Matrix3d R = rows.leftCols<3>();
  const double off = (R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(off <= tolerance) || R.determinant() < 0.0)
    throw InputError(mark, "the first three columns of the matrix are no rotation");
  return checked_pose(rows.col(3), Eigen::Quaterniond(R).normalized(), mark);
}

std::vector<StampedPose> read_euroc(std::string_view text, const std::string& file) {
  std::vector<StampedPose> poses;
  for_each_line(text, [&](std::string_view line, int number) {
    const Mark mark{file, number, 1};
    poses.push_back(parse_euroc(split(line), mark));
    if (poses.size() > 1 && poses.back().stamp <= poses[poses.size() - 2].stamp)
      throw InputError(mark, "stamps must increase from line to line");
    return true;
  });
  return poses;
}

std::vector<StampedPose> kitti_at(std::span<const Nanoseconds> scans, std::string_view text, const std::string& file) {
  const std::vector<Pose> read = read_kitti(text, file);
  if (read.size() != scans.size())
    throw InputError({file, 0, 0}, "holds " + std::to_string(read.size()) +
                                       " poses in KITTI form, which has no times, and "
                                       "there are " +
                                       std::to_string(scans.size()) + " scans; give one pose a scan, or a TUM file");
  std::vector<StampedPose> poses;
  for (std::size_t i = 0; i < read.size(); ++i) poses.push_back({scans[i], read[i]});
  return poses;
}

}  // namespace

TrajectoryForm trajectory_form(std::string_view text) {
  TrajectoryForm form = TrajectoryForm::tum;
  for_each_line(text, [&](std::string_view line, int /*number*/) {
    if (line.find(',') != std::string_view::npos)
      form = TrajectoryForm::euroc;
    else if (split(line).size() == kitti_columns)
      form = TrajectoryForm::kitti;
    return false;
  });
  return form;
}

std::vector<Pose> read_kitti(std::string_view text, const std::string& file) {
  std::vector<Pose> poses;
  for_each_line(text, [&](std::string_view line, int number) {
    poses.push_back(parse_kitti(split(line), {file, number, 1}));
    return true;
  });
  return poses;
}

std::vector<StampedPose> in_other_order(std::vector<StampedPose> poses, TrajectoryForm form) {
  if (form == TrajectoryForm::kitti) return poses;
  for (StampedPose& pose : poses) {
    const Eigen::Quaterniond q = pose.X_FR.q;
    pose.X_FR.q = form == TrajectoryForm::tum ? Eigen::Quaterniond(q.x(), q.y(), q.z(), q.w())
                                              : Eigen::Quaterniond(q.z(), q.w(), q.x(), q.y());
  }
  return poses;
}

std::vector<StampedPose> read_trajectory(std::string_view text, const std::string& file,
                                         std::span<const Nanoseconds> scans) {
  text = without_byte_order_mark(text);
  if (text.find('\0') != std::string_view::npos)
    throw InputError({file, 0, 0}, "is no text; poses in the form of TUM, KITTI or EuRoC would be right");
  switch (trajectory_form(text)) {
    case TrajectoryForm::euroc:
      return read_euroc(text, file);
    case TrajectoryForm::kitti:
      return kitti_at(scans, text, file);
    default:
      return read_tum(text, file);
  }
}

}  // namespace plumbline::slam
