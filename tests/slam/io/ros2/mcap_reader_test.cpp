// SPDX-License-Identifier: Apache-2.0
#include "slam/io/ros2/mcap_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <iterator>

#include "slam/io/ros2/ros2_writer.h"
#include "tests/folder.h"

namespace plumbline::slam {
namespace {

std::string bytes(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}
void write_bytes(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary).write(text.data(), static_cast<std::streamsize>(text.size()));
}

/// Sets what each chunk of an MCAP file says of the time of its first message to 0; returns where the chunks begin.
std::vector<std::size_t> without_chunk_times(std::string& mcap) {
  std::vector<std::size_t> chunks;
  constexpr std::size_t magic = 8, head = 9;
  for (std::size_t at = magic; at + head < mcap.size();) {
    std::uint64_t size = 0;
    std::memcpy(&size, &mcap[at + 1], sizeof size);
    if (mcap[at] == '\x06') {
      chunks.push_back(at);
      std::fill_n(mcap.begin() + static_cast<std::ptrdiff_t>(at + head), 8, '\0');
    }
    at += head + size;
  }
  return chunks;
}

TEST(McapReader, ChunksWithoutTimesAreInTheOrderOfTheirMessages) {
  const Folder folder;
  const std::string file = folder / "a.mcap";
  constexpr std::array<int, 4> times = {7, 3, 5, 1};
  {
    const auto writer = make_mcap_writer(file, "zstd");
    const auto topic = writer->add_topic({"/odom", "nav_msgs/msg/Odometry", "x", ""});
    for (const int time : times)
      writer->write(topic, time, std::vector<std::uint8_t>(1'200'000, static_cast<std::uint8_t>(time)));
    writer->finish();
  }
  std::string mcap = bytes(file);
  ASSERT_EQ(without_chunk_times(mcap).size(), times.size());
  write_bytes(file, mcap);
  const auto source = open_mcap(file);
  EXPECT_EQ(source->start(), 1);
  source->select({"/odom"});
  std::vector<Nanoseconds> found;
  for (RawMessage message; source->next(message);) found.push_back(message.time);
  EXPECT_EQ(found, (std::vector<Nanoseconds>{1, 3, 5, 7}));
}

// More than may be in memory at once, were all chunks opened.
TEST(McapReader, ChunksOfOneTimeAreOpenedOneAfterTheOther) {
  const Folder folder;
  const std::string file = folder / "a.mcap";
  constexpr int count = 140;
  for (const bool constant : {true, false}) {
    {
      const auto writer = make_mcap_writer(file, "zstd");
      const auto topic = writer->add_topic({"/odom", "nav_msgs/msg/Odometry", "x", ""});
      std::vector<std::uint8_t> message(8U << 20U);
      for (int i = 0; i < count; ++i) {
        message[0] = static_cast<std::uint8_t>(i);
        writer->write(topic, constant ? 0 : i + 1, message);
      }
      writer->finish();
    }
    std::string mcap = bytes(file);
    ASSERT_EQ(without_chunk_times(mcap).size(), static_cast<std::size_t>(count));
    write_bytes(file, mcap);
    const auto source = open_mcap(file);
    source->select({"/odom"});
    int next = 0;
    for (RawMessage message; source->next(message); ++next) EXPECT_EQ(message.bytes[0], next);
    EXPECT_EQ(next, count);
  }
}

}  // namespace
}  // namespace plumbline::slam
