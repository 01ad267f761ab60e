// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "bim/errors.h"
#include "slam/io/bags/bag_check.h"
#include "slam/io/bags/ros1_unindexed.h"
#include "slam/io/bags/ros_message.h"
#include "slam/io/packets/point_cloud.h"
#include "slam/io/ros2/mcap_reader.h"
#include "slam/io/ros2/rosbag2_reader.h"

namespace {

using plumbline::slam::Encoding;

/// In memory, since SQLite opens by name.
const std::string& folder() {
  static const std::string path = [] {
    std::string made = "/dev/shm/plumbline_fuzz_" + std::to_string(::getpid());
    std::filesystem::create_directories(made);
    return made;
  }();
  return path;
}

std::string file_with(const std::string& name, std::span<const std::uint8_t> bytes) {
  const std::string path = folder() + "/" + name;
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "wb"), &std::fclose);
  if (!file || std::fwrite(bytes.data(), 1, bytes.size(), file.get()) != bytes.size()) std::abort();
  return path;
}

void read_all(plumbline::slam::MessageSource& source) {
  std::vector<std::string> names;
  for (const auto& topic : source.topics()) names.push_back(topic.name);
  source.select(names);
  for (plumbline::slam::RawMessage message; source.next(message);) {
  }
}

/// Also as if it had no index.
void read_bag(const std::string& file) {
  read_all(*plumbline::slam::open_unindexed_bag(file, [](const auto&, auto) { return Encoding::ros1; }));
  (void)plumbline::slam::check_bag(file);
}

/// The first byte chooses the message.
void read_message(std::span<const std::uint8_t> bytes) {
  namespace ros = plumbline::slam::ros;
  if (bytes.empty()) return;
  const auto rest = bytes.subspan(1);
  switch (bytes[0] % 5) {
    case 0:
      (void)plumbline::slam::scan_of(ros::read_cloud(rest, Encoding::cdr).cloud);
      break;
    case 1:
      (void)plumbline::slam::scan_of(ros::read_livox(rest, Encoding::cdr).cloud);
      break;
    case 2:
      (void)ros::read_odometry(rest, Encoding::cdr);
      break;
    case 3:
      (void)ros::read_imu(rest, Encoding::cdr);
      break;
    default:
      (void)ros::read_transforms(rest, Encoding::cdr);
  }
}

}  // namespace

/// The first byte chooses what the rest is: an MCAP file, a rosbag2's database or metadata, a ROS 1 bag or a message in
/// CDR; it can be read, or is an InputError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::span<const std::uint8_t> rest(data + 1, size - 1);
  try {
    switch (data[0] % 5) {
      case 0:
        read_all(*plumbline::slam::open_mcap(file_with("fuzz.mcap", rest)));
        break;
      case 1:
        read_all(*plumbline::slam::open_rosbag2_database(file_with("fuzz.db3", rest)));
        break;
      case 2:
        file_with("metadata.yaml", rest);
        read_all(*plumbline::slam::open_rosbag2_folder(folder()));
        break;
      case 3:
        read_bag(file_with("fuzz.bag", rest));
        break;
      default:
        read_message(rest);
    }
  } catch (const plumbline::InputError&) {
  }
  return 0;
}
