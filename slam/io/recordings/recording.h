// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "slam/io/packets/vlp16.h"
#include "slam/io/recordings/recording_info.h"
#include "slam/io/recordings/sensor_frame.h"

namespace plumbline::slam {

/// From where the LiDAR's pose on the robot is known.
enum class MountSource { unknown, description, tf_static, tf, same_frame };
[[nodiscard]] constexpr std::array<std::string_view, 5> names_of(MountSource) {
  return {"unknown", "description", "tf_static", "tf", "same_frame"};
}

/// What of a recording is read. Topics and frames are a bag's, empty elsewhere.
struct Taken {
  std::string points, odometry, imu;
  std::vector<std::string> other_points;     ///< topics that could have been taken
  std::string frame;                         ///< of the points
  MountSource mount = MountSource::unknown;  ///< unknown: R is the LiDAR's frame
  std::string robot;                         ///< R, by its name in the recording
};

/// Records of a simulated or a real robot, read as a stream, in memory that hardly grows with its length. What comes
/// late or out of order is waited for: some twenty scans of a bag, up to 1 GiB of chunks of an MCAP file.
class Recording {
 public:
  virtual ~Recording() = default;
  /// The next scan with what came before it; false at the end. Times count from the start of the recording. Throws
  /// InputError, naming the place, on anything that is not as it should be and is not left out.
  [[nodiscard]] virtual bool next(SensorFrame& frame) = 0;
  [[nodiscard]] virtual const RecordingInfo& info() const = 0;
  [[nodiscard]] virtual bool has_odometry() const = 0;
  /// Time 0 on the recording's own clock, known after the first scan; 0 where the two are one.
  [[nodiscard]] virtual Nanoseconds origin() const = 0;
  [[nodiscard]] virtual Taken taken() const = 0;
  /// Of what could not be used so far and was left out, a sentence for each topic and reason.
  [[nodiscard]] virtual std::vector<std::string> left_out() const { return {}; }
  /// What was assumed of its numbers, or does not fit together, a sentence each.
  [[nodiscard]] virtual std::vector<std::string> assumed() const { return {}; }
};

/// Error message for odometry that overlaps no scan.
inline constexpr std::string_view no_odometry = "no odometry at or before any scan; are both on one clock?";
inline constexpr std::string_view odometry_over = "the odometry ends before the first scan; are both on one clock?";

/// Files of a recording directory.
namespace recording_files {
inline constexpr std::string_view info = "recording.yaml";
inline constexpr std::string_view lidar = "lidar.pcap";
inline constexpr std::string_view odometry = "odometry.tum";
inline constexpr std::string_view covariance = "odometry_covariance.csv";
inline constexpr std::string_view imu = "imu.csv";
}  // namespace recording_files

/// Opens a recording directory (lidar.pcap; recording.yaml, odometry.tum with its covariances and imu.csv where they
/// are there) or a bare capture of a Velodyne LiDAR; `info`, where it is not null, stands for recording.yaml. Messages
/// are cut as drivers do, by the number of packets; scans before the first odometry record and a message that the end
/// or a gap of seconds cuts short are left out. Throws InputError, also where no scan overlaps the odometry.
[[nodiscard]] std::unique_ptr<Recording> open_recording(const std::string& path, const RecordingInfo* info = nullptr);

/// Packets of a full turn, rounded up, at the speed that one packet gives (a multiple of 60 rpm): 76 at 600 rpm.
[[nodiscard]] int packets_per_turn(const Vlp16Packet& packet);

}  // namespace plumbline::slam
