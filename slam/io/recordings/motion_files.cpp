// SPDX-License-Identifier: Apache-2.0
#include "slam/io/recordings/motion_files.h"

#include <array>
#include <charconv>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "bim/config/tree.h"
#include "bim/config/utf8.h"
#include "bim/config/words.h"
#include "bim/errors.h"
#include "slam/io/recordings/record_file.h"
#include "slam/io/recordings/trajectory.h"
#include "slam/io/recordings/tum.h"
#include "slam/io/second.h"

namespace plumbline::slam {

namespace {

constexpr Nanoseconds longest_sweep = 2'000'000'000;
constexpr std::string_view no_imu = "no record of the IMU lies within the time of the scans; are both on one clock?";

/// Of EuRoC: whole nanoseconds, then six numbers, with commas between them.
Imu parse_euroc_imu(std::string_view line, const Mark& mark) {
  Imu record;
  std::array<double, 6> v{};
  std::size_t columns = 0;
  bool good = true;
  for (std::string_view rest = line; good;) {
    const std::size_t end_of_column = rest.find(',');
    const std::string_view text = without_blanks(rest.substr(0, end_of_column));
    if (columns == 0) {
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), record.stamp);
      good = error == std::errc() && end == text.data() + text.size() && record.stamp > -furthest_stamp &&
             record.stamp < furthest_stamp;
    } else {
      good = columns <= v.size() && parse_number(text, v[columns - 1]);
    }
    ++columns;
    if (end_of_column == std::string_view::npos) break;
    rest.remove_prefix(end_of_column + 1);
  }
  if (!good || columns != v.size() + 1)
    throw InputError(mark,
                     "is no line of an IMU: a first line '" + std::string(imu_header) +
                         "' and seconds below it, or lines of whole nanoseconds and six numbers as EuRoC's would be "
                         "right");
  record.angular_velocity_R = {v[0], v[1], v[2]};
  record.linear_acceleration_R = {v[3], v[4], v[5]};
  return record;
}

std::vector<Imu> read_euroc_imu(const std::string& path) {
  LineReader lines(path);
  std::vector<Imu> records;
  for (std::string line; lines.next(line);) {
    records.push_back(parse_euroc_imu(records.empty() ? without_byte_order_mark(line) : line, lines.mark()));
    if (records.size() > 1 && records.back().stamp <= records[records.size() - 2].stamp)
      throw InputError(lines.mark(), "stamps must increase from line to line");
  }
  return records;
}

bool has_header(const std::string& path) {
  LineReader lines(path);
  std::string line;
  return lines.next(line) && line == imu_header;
}

std::vector<Imu> read_imu(const std::string& path) {
  if (!has_header(path)) return read_euroc_imu(path);
  ImuReader reader(path);
  std::vector<Imu> records;
  for (Imu record; reader.next(record);) records.push_back(record);
  return records;
}

std::string name_of(const std::string& path) { return std::filesystem::path(path).filename().string(); }

class WithMotion final : public Recording {
 public:
  WithMotion(std::unique_ptr<Recording> recording, const MotionFiles& files)
      : recording_(std::move(recording)), files_(files) {
    if (!files_.odometry.empty()) read_odometry();
    if (files_.imu.empty()) return;
    imu_ = read_imu(files_.imu);
    if (imu_.empty()) throw InputError({files_.imu, 0, 0}, "holds no record of an IMU");
  }

  [[nodiscard]] const RecordingInfo& info() const override { return recording_->info(); }
  [[nodiscard]] bool has_odometry() const override { return !files_.odometry.empty() || recording_->has_odometry(); }
  [[nodiscard]] Nanoseconds origin() const override { return recording_->origin(); }
  [[nodiscard]] std::vector<std::string> assumed() const override { return recording_->assumed(); }
  [[nodiscard]] Taken taken() const override {
    Taken taken = recording_->taken();
    if (!files_.odometry.empty()) taken.odometry = name_of(files_.odometry);
    if (!files_.imu.empty()) taken.imu = name_of(files_.imu);
    return taken;
  }
  [[nodiscard]] std::vector<std::string> left_out() const override {
    std::vector<std::string> said = recording_->left_out();
    if (early_ > 0)
      said.push_back(std::to_string(early_) + " of " + std::to_string(scans_) +
                     " scans left out: before the first odometry");
    return said;
  }

  [[nodiscard]] bool next(SensorFrame& frame) override {
    std::vector<Imu> before;  // of scans that are left out
    for (SensorFrame out; recording_->next(out); out = {}) {
      ++scans_;
      if (!files_.imu.empty()) take_imu(out);
      out.imu.insert(out.imu.begin(), before.begin(), before.end());
      if (!files_.odometry.empty() && !take_odometry(out)) {
        ++early_;
        before = std::move(out.imu);
        continue;
      }
      frame = std::move(out);
      return true;
    }
    check_end();
    return false;
  }

 private:
  void read_odometry() {
    if (recording_->has_odometry())
      throw InputError({files_.odometry, 0, 0}, "the recording has odometry of its own; without this file it is read");
    const std::string read = read_text_file(files_.odometry);
    const std::string_view text = without_byte_order_mark(read);
    is_of_scans_ = trajectory_form(text) == TrajectoryForm::kitti;
    if (is_of_scans_)
      for (const Pose& X_OR : read_kitti(text, files_.odometry)) odometry_.push_back({0, X_OR});
    else
      odometry_ = read_trajectory(text, files_.odometry, {});
    if (odometry_.empty()) throw InputError({files_.odometry, 0, 0}, "holds no pose");
  }

  void take_imu(SensorFrame& frame) {
    if (!frame.imu.empty())
      throw InputError({files_.imu, 0, 0}, "the recording has an IMU of its own; without this file it is read");
    const bool first = next_imu_ == 0;
    const Nanoseconds until = frame.scan.stamp + origin();
    for (; next_imu_ < imu_.size() && imu_[next_imu_].stamp <= until; ++next_imu_) {
      frame.imu.push_back(imu_[next_imu_]);
      frame.imu.back().stamp -= origin();
    }
    if (first && next_imu_ == imu_.size() && until - imu_.back().stamp > longest_sweep)
      throw InputError({files_.imu, 0, 0}, std::string(no_imu));
  }

  /// False before the first record.
  bool take_odometry(SensorFrame& frame) {
    const std::size_t before = next_odometry_;
    if (is_of_scans_) {
      if (next_odometry_ == odometry_.size()) fail_count();
      frame.odometry.push_back({frame.scan.stamp, odometry_[next_odometry_++].X_FR});
      return true;
    }
    for (; next_odometry_ < odometry_.size(); ++next_odometry_) {
      const StampedPose& pose = odometry_[next_odometry_];
      if (pose.stamp > frame.scan.stamp + origin()) break;
      frame.odometry.push_back({pose.stamp - origin(), pose.X_FR});
    }
    if (before == 0 && next_odometry_ == odometry_.size() &&
        frame.scan.stamp - frame.odometry.back().stamp > longest_sweep)
      throw InputError({files_.odometry, 0, 0}, std::string(odometry_over));
    return next_odometry_ > 0;
  }

  void check_end() const {
    if (scans_ == 0) return;
    if (!imu_.empty() && next_imu_ == 0) throw InputError({files_.imu, 0, 0}, std::string(no_imu));
    if (files_.odometry.empty()) return;
    if (early_ == scans_) throw InputError({files_.odometry, 0, 0}, std::string(no_odometry));
    if (is_of_scans_ && next_odometry_ < odometry_.size()) fail_count();
  }

  [[noreturn]] void fail_count() const {
    throw InputError({files_.odometry, 0, 0}, "holds " + std::to_string(odometry_.size()) +
                                                  " poses without times, which is not one for each scan; a file "
                                                  "with times, in the form of TUM or EuRoC, would be right");
  }

  std::unique_ptr<Recording> recording_;
  MotionFiles files_;
  std::vector<StampedPose> odometry_;
  std::vector<Imu> imu_;
  bool is_of_scans_ = false;  ///< the odometry has no times
  std::size_t next_odometry_ = 0, next_imu_ = 0;
  std::int64_t scans_ = 0, early_ = 0;  ///< early: before the first odometry
};

}  // namespace

std::unique_ptr<Recording> with_motion(std::unique_ptr<Recording> recording, const MotionFiles& files) {
  if (files.odometry.empty() && files.imu.empty()) return recording;
  return std::make_unique<WithMotion>(std::move(recording), files);
}

}  // namespace plumbline::slam
