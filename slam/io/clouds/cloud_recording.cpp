// SPDX-License-Identifier: Apache-2.0
#include "slam/io/clouds/cloud_recording.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "bim/config/tree.h"
#include "bim/errors.h"
#include "slam/io/clouds/cloud_file.h"

namespace plumbline::slam {

namespace fs = std::filesystem;

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// The run of digits that starts at i.
std::string_view digits_at(std::string_view name, std::size_t i) {
  std::size_t end = i;
  while (end < name.size() && is_digit(name[end])) ++end;
  return name.substr(i, end - i);
}

std::string_view without_zeros(std::string_view digits) {
  return digits.substr(std::min(digits.find_first_not_of('0'), digits.size()));
}

/// 7.pcd before 10.pcd; digits behind a decimal point, as of a stamp, by their places.
bool is_earlier_name(const std::string& a, const std::string& b) {
  std::size_t i = 0, k = 0;
  while (i < a.size() && k < b.size()) {
    if (!is_digit(a[i]) || !is_digit(b[k])) {
      if (a[i] != b[k]) return a[i] < b[k];
      ++i, ++k;
      continue;
    }
    const bool is_fraction = i > 1 && a[i - 1] == '.' && is_digit(a[i - 2]);
    const std::string_view of_a = digits_at(a, i), of_b = digits_at(b, k);
    const std::string_view number_a = is_fraction ? of_a : without_zeros(of_a);
    const std::string_view number_b = is_fraction ? of_b : without_zeros(of_b);
    if (!is_fraction && number_a.size() != number_b.size()) return number_a.size() < number_b.size();
    if (number_a != number_b) return number_a < number_b;
    i += of_a.size();
    k += of_b.size();
  }
  return a < b;
}

/// Names of the clouds in order; none where there is anything else than clouds of one ending and recording.yaml.
std::vector<std::string> names_of_clouds(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (name == recording_files::info) continue;
    if (!is_cloud_file(name) || !it->is_regular_file()) return {};
    names.push_back(name);
  }
  std::sort(names.begin(), names.end(), is_earlier_name);
  for (const std::string& name : names)
    if (cloud_format_of(name) != cloud_format_of(names.front())) return {};
  return names;
}

class CloudRecording final : public Recording {
 public:
  CloudRecording(std::string folder, RecordingInfo info, MountSource mount)
      : folder_(std::move(folder)),
        info_(std::move(info)),
        mount_(mount),
        period_(static_cast<Nanoseconds>(info_.lidar.period_s * 1e9)),
        names_(names_of_clouds(folder_)) {
    if (names_.empty())
      throw InputError({folder_, 0, 0}, "is no folder of point clouds, all of them .pcd or all of them .ply");
    find_times();
  }

  [[nodiscard]] bool next(SensorFrame& frame) override {
    if (next_ == names_.size()) return false;
    CloudScan read = scan_at(next_);
    without_rings_ += read.rings_left_out ? 1 : 0;
    frame = {};
    frame.scan = std::move(read.scan);
    if (sweep_of(frame.scan) > period_ + period_ / 10)
      throw InputError({file_of(next_), 0, 0},
                       "its points are measured for longer than a period; recording.yaml beside the clouds, "
                       "or --description, says what that is: lidar: {period_s: 0.2}");
    ++next_;
    frame.scan.stamp = std::max(frame.scan.stamp, last_ + 1);
    last_ = frame.scan.stamp;
    return true;
  }

  [[nodiscard]] const RecordingInfo& info() const override { return info_; }
  [[nodiscard]] bool has_odometry() const override { return false; }
  [[nodiscard]] Nanoseconds origin() const override { return 0; }
  [[nodiscard]] std::vector<std::string> left_out() const override {
    if (without_rings_ == 0) return {};
    return {std::to_string(without_rings_) + " of " + std::to_string(next_) + " scans read " +
            std::string(one_ring_number)};
  }
  [[nodiscard]] std::vector<std::string> assumed() const override {
    if (times_.said.empty()) return {};
    return {times_.said};
  }
  [[nodiscard]] Taken taken() const override {
    Taken taken;
    taken.mount = mount_;
    return taken;
  }

 private:
  [[nodiscard]] std::string file_of(std::size_t i) const { return folder_ + "/" + names_[i]; }

  [[nodiscard]] Nanoseconds stamp_of(std::size_t i) const { return static_cast<Nanoseconds>(i) * period_; }

  [[nodiscard]] PointCloud cloud_at(std::size_t i) const {
    PointCloud cloud = read_cloud_file(file_of(i));
    cloud.stamp = stamp_of(i);
    return cloud;
  }

  /// What a cloud has wrong is said with its file's name.
  [[nodiscard]] CloudScan scan_at(std::size_t i) const {
    PointCloud cloud = cloud_at(i);
    // Times that run on through the clouds must not drift from stamps that are only made up.
    if (times_.times.base == TimeBase::day && last_ >= 0) cloud.stamp = last_;
    try {
      return read_scan(cloud, times_.times);
    } catch (const InputError& error) {
      throw InputError({file_of(i), 0, 0}, error.what());
    }
  }

  /// From the first return to the stamp.
  [[nodiscard]] static Nanoseconds sweep_of(const Scan& scan) {
    const auto first = std::min_element(scan.offset_ns.begin(), scan.offset_ns.end());
    return first == scan.offset_ns.end() ? 0 : -*first;
  }

  /// Clouds from the first one on that cannot be read tell nothing; next() refuses that one.
  void find_times() {
    const auto show_clouds = [&](const auto& add) {
      try {
        for (std::size_t i = 0; i < names_.size() && add(cloud_at(i));) ++i;
      } catch (const InputError&) {
      }
    };
    TimeBaseSearch search;
    show_clouds([&](const PointCloud& cloud) { return search.add(cloud); });
    SweepLengthSearch lengths(search.base());
    show_clouds([&](const PointCloud& cloud) { return lengths.add(cloud); });
    times_ = lengths.found();
  }

  std::string folder_;
  RecordingInfo info_;
  MountSource mount_;
  Nanoseconds period_;
  std::vector<std::string> names_;
  AssumedTimes times_;
  std::size_t next_ = 0;
  Nanoseconds last_ = -1;
  std::size_t without_rings_ = 0;  ///< scans
};

}  // namespace

bool is_cloud_folder(const std::string& path) { return fs::is_directory(path) && !names_of_clouds(path).empty(); }

std::string why_no_cloud_folder(const std::string& path) {
  if (is_cloud_folder(path)) return {};
  std::size_t clouds = 0, raw = 0, others = 0;
  std::string other;  // the first by name
  std::error_code error;
  for (fs::directory_iterator it(path, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (name == recording_files::info) continue;
    if (is_cloud_file(name) && it->is_regular_file()) {
      ++clouds;
      continue;
    }
    ++others;
    raw += name.ends_with(".bin") ? 1 : 0;
    if (other.empty() || name < other) other = name;
  }
  if (raw > others / 2) return "files .bin, as KITTI's, which are not read; .pcd or .ply would be right";
  if (clouds <= others) return {};
  if (others > 0)
    return "point clouds and beside them '" + other.substr(0, 80) +
           "'; a folder of clouds would hold .pcd or .ply files, and recording.yaml, alone";
  return "point clouds of more than one ending; all .pcd or all .ply would be right";
}

std::unique_ptr<Recording> open_cloud_folder(const std::string& path, const RecordingInfo* info) {
  const std::string file = path + "/" + std::string(recording_files::info);
  RecordingInfo description;
  if (info != nullptr)
    description = *info;
  else if (fs::exists(file))
    description = read_recording_info(read_text_file(file), file);
  const bool described = info != nullptr || fs::exists(file);
  return std::make_unique<CloudRecording>(path, std::move(description),
                                          described ? MountSource::description : MountSource::unknown);
}

}  // namespace plumbline::slam
