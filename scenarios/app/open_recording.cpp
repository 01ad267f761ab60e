// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/open_recording.h"

#include <filesystem>
#include <optional>
#include <utility>

#include "bim/config/file_ending.h"
#include "bim/errors.h"
#include "scenarios/host/files.h"
#include "scenarios/run/run_files.h"
#include "slam/io/clouds/bin_cloud.h"
#include "slam/io/clouds/cloud_header.h"
#include "slam/io/clouds/cloud_recording.h"
#include "slam/io/ros2/bag_files.h"

namespace plumbline::scenarios {

namespace {

/// Of a LiDAR that sends no packets simulate leaves bags alone, with the description beside it; empty: none.
std::string bag_beside(const std::string& folder) {
  namespace fs = std::filesystem;
  std::string bag;
  for (const char* name : {"/rosbag2", "/recording.mcap", "/recording.bag"})
    if (fs::exists(folder + name)) bag = folder + name;
  return fs::exists(folder + "/recording.yaml") && !fs::exists(folder + "/lidar.pcap") ? bag : std::string();
}

std::unique_ptr<slam::Recording> open_folder(const std::string& folder, const slam::BagTopics& topics,
                                             const slam::RecordingInfo* given) {
  const std::string description = folder + "/recording.yaml";
  const std::string bag = bag_beside(folder);
  if (bag.empty()) return slam::open_recording(folder, given);
  const slam::RecordingInfo info =
      given != nullptr ? *given : slam::read_recording_info(read_text_file(description), description);
  return slam::open_bag(bag, topics, &info);
}

void check_no_topics(const RecordingArguments& arguments) {
  for (const auto& [name, value] :
       {std::pair("--points-topic", &arguments.topics.points),
        std::pair("--odometry-topic", &arguments.topics.odometry), std::pair("--imu-topic", &arguments.topics.imu)})
    if (!value->empty()) throw InputError({name, 0, 0}, "is of bags; '" + arguments.recording + "' has no topics");
}

/// What is not there or only has the name of a bag is said before a reader of captures sees it.
void check_kind(const std::string& recording) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (!fs::exists(recording, error))
    throw InputError({recording, 0, 0},
                     "no such file; a recording directory, a capture (.pcap), a bag (.bag, .mcap, .db3 "
                     "or a rosbag2 folder) or a folder of point clouds would be right");
  if (fs::is_directory(recording, error)) {
    if (const std::string several = slam::find_bag_files(recording).several; !several.empty())
      throw InputError({recording, 0, 0}, "holds bags that are not one, " + several + "; give one of them");
    if (const std::string why = slam::why_no_cloud_folder(recording); !why.empty())
      throw InputError({recording, 0, 0}, "holds " + why);
    return;
  }
  if (slam::is_bag(recording)) return;
  for (const char* ending : {".mcap.zstd", ".mcap.zst", ".db3.zstd", ".db3.zst", ".bag.zst", ".mcap.lz4", ".bag.gz"})
    if (has_ending(recording, ending))
      throw InputError({recording, 0, 0}, "is compressed as a whole; decompress it first (zstd -d, lz4 -d or gunzip)");
  if (has_ending(recording, ".bag"))
    throw InputError({recording, 0, 0}, "is no ROS 1 bag; one begins with '#ROSBAG V2.0'");
  if (has_ending(recording, ".mcap") || has_ending(recording, ".db3"))
    throw InputError({recording, 0, 0}, "is no ROS 2 bag; an MCAP or an SQLite file would be right");
  if (slam::is_cloud_file(recording) || slam::is_bin_cloud(recording))
    throw InputError({recording, 0, 0}, "is one scan; give the folder that holds it and others");
}

}  // namespace

// A run directory holds its recording in a folder.
std::unique_ptr<slam::Recording> open_any_recording(const RecordingArguments& arguments) {
  std::optional<slam::RecordingInfo> info;
  if (!arguments.description.empty())
    info = slam::read_recording_info(read_text_file(arguments.description), arguments.description);
  const slam::RecordingInfo* given = info ? &*info : nullptr;
  check_kind(arguments.recording);
  if (slam::is_bag(arguments.recording))
    return with_motion(slam::open_bag(arguments.recording, arguments.topics, given), arguments.motion);
  const std::string inner = arguments.recording + "/" + std::string(recording_folder);
  const std::string folder = std::filesystem::is_directory(inner) ? inner : arguments.recording;
  if (slam::is_cloud_folder(arguments.recording) || bag_beside(folder).empty()) check_no_topics(arguments);
  if (slam::is_cloud_folder(arguments.recording))
    return slam::open_cloud_folder(arguments.recording, given, arguments.motion);
  return with_motion(open_folder(folder, arguments.topics, given), arguments.motion);
}

}  // namespace plumbline::scenarios
