// SPDX-License-Identifier: Apache-2.0
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>
#include <string_view>

#include "bim/errors.h"
#include "slam/io/bags/ros_message.h"
#include "slam/io/packets/point_cloud.h"
#include "slam/io/recordings/record_file.h"
#include "slam/io/recordings/recording.h"

namespace {

using Bytes = std::string_view;

/// A file in memory with these bytes.
class MemoryFile {
 public:
  explicit MemoryFile(Bytes bytes) : fd_(memfd_create("fuzz", 0)) {
    if (fd_ < 0 || write(fd_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size())) std::abort();
  }
  ~MemoryFile() { close(fd_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(fd_); }

 private:
  int fd_;
};

void read_capture(Bytes bytes) {
  const MemoryFile file(bytes);
  plumbline::slam::RecordingInfo info;
  info.lidar.packets_per_message = 2;  // inputs are short
  const auto recording = plumbline::slam::open_recording(file.path(), &info);
  for (plumbline::slam::SensorFrame frame; recording->next(frame);) {
  }
}

template <class Reader, class Record>
void read_records(Bytes bytes) {
  const MemoryFile file(bytes);
  Reader reader(file.path());
  for (Record record; reader.next(record);) {
  }
}

/// The first bytes are the cloud's numbers, the others its points.
void read_cloud(Bytes bytes) {
  if (bytes.size() < 16) return;
  const auto at = [&](std::size_t i) { return static_cast<std::uint8_t>(bytes[i]); };
  plumbline::slam::PointCloud cloud;
  cloud.width = at(0) | static_cast<std::uint32_t>(at(1) << 8);
  cloud.height = at(2);
  cloud.point_step = at(3);
  cloud.row_step = cloud.width * cloud.point_step + at(4) % 3;
  constexpr std::array<const char*, 6> names = {"x", "y", "z", "intensity", "ring", "time"};
  for (std::size_t i = 0; i < names.size(); ++i)
    cloud.fields.push_back({names[i], at(5 + i) % 32U, static_cast<plumbline::slam::PointType>(1 + at(5 + i) / 32)});
  cloud.data.assign(bytes.begin() + 16, bytes.end());
  (void)plumbline::slam::scan_of(cloud);
}

/// The first byte chooses the message of a bag.
void read_message(Bytes bytes) {
  namespace ros = plumbline::slam::ros;
  if (bytes.empty()) return;
  const std::span rest(reinterpret_cast<const std::uint8_t*>(bytes.data()) + 1, bytes.size() - 1);
  switch (bytes[0] & 3) {
    case 0:
      (void)plumbline::slam::scan_of(ros::read_cloud(rest).cloud);
      break;
    case 1:
      (void)ros::read_odometry(rest);
      break;
    case 2:
      (void)ros::read_imu(rest);
      break;
    default:
      (void)ros::read_transforms(rest);
  }
}

}  // namespace

/// The first byte chooses what the rest is: a capture, odometry.tum, imu.csv, recording.yaml, a point cloud or a
/// message of a bag; it can be read, or is an InputError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const Bytes rest(reinterpret_cast<const char*>(data + 1), size - 1);
  try {
    switch (data[0] % 6) {
      case 0:
        read_capture(rest);
        break;
      case 1:
        read_records<plumbline::slam::OdometryReader, plumbline::slam::Odometry>(rest);
        break;
      case 2:
        read_records<plumbline::slam::ImuReader, plumbline::slam::Imu>(rest);
        break;
      case 3:
        (void)plumbline::slam::read_recording_info(rest, "fuzz.yaml");
        break;
      case 4:
        read_cloud(rest);
        break;
      default:
        read_message(rest);
    }
  } catch (const plumbline::InputError&) {
  }
  return 0;
}
