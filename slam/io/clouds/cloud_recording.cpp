// SPDX-License-Identifier: Apache-2.0
#include "slam/io/clouds/cloud_recording.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <utility>
#include <vector>

#include "bim/config/tree.h"
#include "bim/errors.h"
#include "slam/io/clouds/cloud_file.h"

namespace plumbline::slam {

namespace fs = std::filesystem;

namespace {

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
  std::sort(names.begin(), names.end());
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
  }

  [[nodiscard]] bool next(SensorFrame& frame) override {
    if (next_ == names_.size()) return false;
    const std::string file = folder_ + "/" + names_[next_];
    PointCloud cloud = read_cloud_file(file);
    cloud.stamp = static_cast<Nanoseconds>(next_) * period_;
    frame = {};
    try {
      CloudScan read = read_scan(cloud);
      without_rings_ += read.rings_left_out ? 1 : 0;
      frame.scan = std::move(read.scan);
    } catch (const InputError& error) {
      throw InputError({file, 0, 0}, error.what());
    }
    ++next_;
    if (frame.scan.stamp - cloud.stamp > period_ + period_ / 10)
      throw InputError({file, 0, 0},
                       "its points are measured for longer than a period; recording.yaml beside the clouds, "
                       "or --description, says what that is: lidar: {period_s: 0.2}");
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
  [[nodiscard]] Taken taken() const override {
    Taken taken;
    taken.mount = mount_;
    return taken;
  }

 private:
  std::string folder_;
  RecordingInfo info_;
  MountSource mount_;
  Nanoseconds period_;
  std::vector<std::string> names_;
  std::size_t next_ = 0;
  Nanoseconds last_ = -1;
  std::size_t without_rings_ = 0;  ///< scans
};

}  // namespace

bool is_cloud_folder(const std::string& path) { return fs::is_directory(path) && !names_of_clouds(path).empty(); }

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
