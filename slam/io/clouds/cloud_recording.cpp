// SPDX-License-Identifier: Apache-2.0
#include "slam/io/clouds/cloud_recording.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "bim/config/file_ending.h"
#include "bim/config/tree.h"
#include "bim/errors.h"
#include "slam/io/clock_set_back.h"
#include "slam/io/clouds/bin_cloud.h"
#include "slam/io/clouds/cloud_file.h"
#include "slam/io/clouds/cloud_times.h"
#include "slam/io/clouds/name_order.h"
#include "slam/io/packets/point_units.h"

namespace plumbline::slam {

namespace fs = std::filesystem;

namespace {

/// Of a cloud's file, .pcd.bin apart from .bin; empty of any other.
std::string_view ending_of_cloud(std::string_view name) {
  for (const std::string_view ending : {".pcd.bin", ".bin", ".pcd", ".ply"})
    if (has_ending(name, ending)) return ending;
  return {};
}

bool may_be_beside_clouds(std::string_view name) {
  return name == recording_files::info || name == recording_files::odometry || name == recording_files::imu ||
         std::find(names_of_times.begin(), names_of_times.end(), name) != names_of_times.end();
}

/// Names of the clouds in order; none where there is anything else than clouds of one ending and what belongs to them.
std::vector<std::string> names_of_clouds(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (may_be_beside_clouds(name)) continue;
    if (ending_of_cloud(name).empty() || !it->is_regular_file()) return {};
    names.push_back(name);
  }
  std::sort(names.begin(), names.end(), is_earlier_name);
  for (const std::string& name : names)
    if (ending_of_cloud(name) != ending_of_cloud(names.front())) return {};
  return names;
}

/// The folder that holds the clouds: the path, or one in it by KITTI's name.
std::string folder_of_clouds(const std::string& path) {
  if (!names_of_clouds(path).empty()) return path;
  for (const char* inner : {"/velodyne", "/velodyne_points/data", "/data"})
    if (const auto names = names_of_clouds(path + inner); !names.empty() && is_bin_cloud(names.front()))
      return path + inner;
  return {};
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
      throw InputError({folder_, 0, 0}, "is no folder of point clouds, all of them .pcd, .ply or .bin");
    const auto times = find_cloud_times(folder_);
    stamps_ = times ? stamps_of(names_, *times) : stamps_in(names_);
    named_stamps_ = !times && !stamps_.empty();
    constexpr Nanoseconds day = 86'400'000'000'000;
    if (!stamps_.empty() && stamps_.front() > day) origin_ = stamps_.front();
    find_times();
  }

  [[nodiscard]] bool next(SensorFrame& frame) override {
    while (next_ < names_.size()) {
      CloudScan read = scan_at(next_);
      if (stamps_.empty() && sweep_of(read.scan) > period_ + period_ / 10)
        throw InputError({file_of(next_), 0, 0},
                         "its points are measured for longer than a period; recording.yaml beside the clouds, "
                         "or --description, says what that is: lidar: {period_s: 0.2}");
      ++next_;
      read.scan.stamp -= origin_;
      if (stamps_.empty()) read.scan.stamp = std::max(read.scan.stamp, last_.value_or(-1) + 1);
      if (last_) check_not_set_back(*last_ - read.scan.stamp, {file_of(next_ - 1), 0, 0}, "times of clouds");
      if (last_ && read.scan.stamp <= *last_) {
        check_late(++late_);
        continue;
      }
      without_rings_ += read.rings_left_out ? 1 : 0;
      units_.add(read);
      last_ = read.scan.stamp;
      frame = {};
      frame.scan = std::move(read.scan);
      return true;
    }
    return false;
  }

  [[nodiscard]] const RecordingInfo& info() const override { return info_; }
  [[nodiscard]] bool has_odometry() const override { return false; }
  [[nodiscard]] Nanoseconds origin() const override { return origin_; }
  [[nodiscard]] std::vector<std::string> left_out() const override {
    std::vector<std::string> all;
    if (late_ > 0) all.push_back(share_of_read(late_) + "left out: a time that is no later than that of one before");
    if (without_rings_ > 0) all.push_back(share_of_read(without_rings_) + "read " + std::string(no_ring_numbers));
    return all;
  }
  [[nodiscard]] std::vector<std::string> assumed() const override {
    std::vector<std::string> all = units_.said();
    if (!times_.said.empty()) all.push_back(times_.said);
    if (named_stamps_) all.push_back("the names of the clouds are taken for their stamps");
    if (stamps_.empty() && mount_ == MountSource::unknown)
      all.push_back(
          "no times.txt or timestamps.txt tells the rate of the scans; one each 0.1 s is assumed, and recording.yaml "
          "beside them, or --description, may say another: lidar: {period_s: 0.05}");
    return all;
  }
  [[nodiscard]] Taken taken() const override {
    Taken taken;
    taken.mount = mount_;
    return taken;
  }

 private:
  [[nodiscard]] std::string file_of(std::size_t i) const { return folder_ + "/" + names_[i]; }

  [[nodiscard]] std::string share_of_read(std::size_t scans) const {
    return std::to_string(scans) + " of " + std::to_string(next_) + " scans ";
  }
  void check_late(std::size_t late) const {
    if (2 * late > names_.size())
      throw InputError({folder_, 0, 0},
                       "more than half of the scans have a time that is no later than that of one "
                       "before; at most half are left out");
  }

  [[nodiscard]] Nanoseconds stamp_of(std::size_t i) const {
    return stamps_.empty() ? static_cast<Nanoseconds>(i) * period_ : stamps_[i];
  }

  [[nodiscard]] PointCloud cloud_at(std::size_t i) const {
    const std::string file = file_of(i);
    PointCloud cloud = is_bin_cloud(file) ? read_bin_cloud(file) : read_cloud_file(file);
    cloud.stamp = stamp_of(i);
    return cloud;
  }

  /// What a cloud has wrong is said with its file's name.
  [[nodiscard]] CloudScan scan_at(std::size_t i) const {
    PointCloud cloud = cloud_at(i);
    // Times that run on through the clouds must not drift from stamps that are only made up.
    if (stamps_.empty() && times_.times.base == TimeBase::day && last_) cloud.stamp = *last_;
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
  PointUnits units_;
  std::vector<Nanoseconds> stamps_;  ///< of the clouds, on their own clock; empty: not known
  bool named_stamps_ = false;        ///< they are the clouds' names
  Nanoseconds origin_ = 0;
  std::size_t next_ = 0;
  std::optional<Nanoseconds> last_;  ///< stamp of the scan before
  std::size_t late_ = 0;             ///< scans
  std::size_t without_rings_ = 0;    ///< scans
};

}  // namespace

bool is_cloud_folder(const std::string& path) { return fs::is_directory(path) && !folder_of_clouds(path).empty(); }

std::string why_no_cloud_folder(const std::string& path) {
  if (is_cloud_folder(path)) return {};
  std::size_t clouds = 0, others = 0;
  std::string other;  // the first by name
  std::error_code error;
  for (fs::directory_iterator it(path, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (may_be_beside_clouds(name)) continue;
    if (!ending_of_cloud(name).empty() && it->is_regular_file()) {
      ++clouds;
      continue;
    }
    ++others;
    if (other.empty() || name < other) other = name;
  }
  if (clouds <= others) return {};
  if (others > 0)
    return "point clouds and beside them '" + other.substr(0, 80) +
           "'; a folder of clouds would hold .pcd, .ply or .bin files, times.txt, odometry.tum, imu.csv and "
           "recording.yaml alone";
  return "point clouds of more than one ending; all .pcd, all .ply or all .bin would be right";
}

std::unique_ptr<Recording> open_cloud_folder(const std::string& path, const RecordingInfo* info,
                                             const MotionFiles& given) {
  const std::string inner = folder_of_clouds(path);
  const std::string folder = inner.empty() ? path : inner;
  std::string file = path + "/" + std::string(recording_files::info);
  if (!fs::exists(file)) file = folder + "/" + std::string(recording_files::info);
  RecordingInfo description;
  if (info != nullptr)
    description = *info;
  else if (fs::exists(file))
    description = read_recording_info(read_text_file(file), file);
  const bool described = info != nullptr || fs::exists(file);
  auto clouds = std::make_unique<CloudRecording>(folder, std::move(description),
                                                 described ? MountSource::description : MountSource::unknown);
  const auto beside = [&](std::string_view name) {
    for (const std::string& place : {path, folder})
      if (std::string found = place + "/" + std::string(name); fs::exists(found)) return found;
    return std::string();
  };
  return with_motion(std::move(clouds), {given.odometry.empty() ? beside(recording_files::odometry) : given.odometry,
                                         given.imu.empty() ? beside(recording_files::imu) : given.imu});
}

}  // namespace plumbline::slam
