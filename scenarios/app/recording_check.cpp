// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/recording_check.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

#include "scenarios/host/files.h"
#include "scenarios/host/manifest.h"

namespace plumbline::scenarios {

namespace fs = std::filesystem;

namespace {

bool has_manifest(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(folder / manifest_name, error);
}

bool is_of(const std::string& name, const std::string& part) { return name == part || name.starts_with(part + "/"); }

/// Whether a file of a recording folder matters where the folder is given. Truth and building may be changed and taken
/// away: nothing reads them. Without packets a bag is read, and nothing of what belongs to them.
bool is_read(const std::string& name, const fs::path& folder) {
  constexpr std::array<std::string_view, 5> of_packets = {"lidar.pcap", "odometry.tum", "odometry_covariance.csv",
                                                          "imu.csv", "recording.yaml"};
  if (std::find(of_packets.begin(), of_packets.end(), name) != of_packets.end())
    return fs::exists(folder / "lidar.pcap");
  if (!fs::exists(folder / name) || name == "truth.tum" || name.starts_with("building.")) return false;
  const bool is_bag = is_of(name, "recording.bag") || is_of(name, "recording.mcap") || is_of(name, "rosbag2");
  return !is_bag || !fs::exists(folder / "lidar.pcap");
}

}  // namespace

// A run directory holds its recording in a folder. A bag stands in that of its recording.
AlteredRecording altered_in_recording(const std::string& recording) {
  std::error_code error;
  fs::path given = fs::absolute(recording).lexically_normal();
  if (!given.has_filename()) given = given.parent_path();
  if (fs::is_directory(given / recording_folder, error)) given /= recording_folder;
  AlteredRecording altered{given.string(), {}};
  if (fs::is_directory(given, error) && has_manifest(given)) {
    for (const std::string& name : altered_files(given.string(), {}))
      if (name == manifest_name || is_read(name, given)) altered.files.push_back(name);
    return altered;
  }
  altered.folder = given.parent_path().string();
  if (!has_manifest(given.parent_path())) return altered;
  for (const std::string& name : altered_files(altered.folder, {}))
    if (name == manifest_name || is_of(name, given.filename().string())) altered.files.push_back(name);
  return altered;
}

}  // namespace plumbline::scenarios
