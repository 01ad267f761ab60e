// SPDX-License-Identifier: Apache-2.0
#include "slam/io/ros2/mcap_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <iterator>
#include <utility>

#include "slam/io/ros2/ros2_writer.h"
#include "tests/folder.h"
#include "tests/input_error.h"

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

/// An MCAP file of chunks with one message of 2 MB each, at 1, 2, 3.
std::string three_chunks(const Folder& folder, const std::string& compression) {
  const std::string file = folder / "whole.mcap";
  const auto writer = make_mcap_writer(file, compression);
  const auto topic = writer->add_topic({"/odom", "nav_msgs/msg/Odometry", "x", ""});
  for (const int time : {1, 2, 3})
    writer->write(topic, time, std::vector<std::uint8_t>(2'000'000, static_cast<std::uint8_t>(time)));
  writer->finish();
  return bytes(file);
}

struct Found {
  std::vector<Nanoseconds> times;
  std::string left_out;
};

Found read_cut(const Folder& folder, const std::string& mcap) {
  const std::string file = folder / "cut.mcap";
  write_bytes(file, mcap);
  const auto source = open_mcap(file);
  source->select({"/odom"});
  Found found;
  for (RawMessage message; source->next(message);) found.times.push_back(message.time);
  for (const std::string& said : source->left_out()) found.left_out += said;
  return found;
}

TEST(McapReader, AFileThatWasNotClosedIsReadAsFarAsItIsWhole) {
  const Folder folder;
  for (const char* compression : {"", "zstd", "lz4"}) {
    std::string mcap = three_chunks(folder, compression);
    EXPECT_EQ(read_cut(folder, mcap).left_out, "");
    const std::vector<std::size_t> chunks = without_chunk_times(mcap);
    ASSERT_EQ(chunks.size(), 3U);
    const Found without_magic = read_cut(folder, mcap.substr(0, mcap.size() - 1));
    EXPECT_EQ(without_magic.times, (std::vector<Nanoseconds>{1, 2, 3}));
    EXPECT_NE(without_magic.left_out.find("all that it holds is read"), std::string::npos);
    for (const std::size_t into : {std::size_t{0}, std::size_t{5}, std::size_t{60}, (mcap.size() - chunks[2]) / 8}) {
      const Found cut = read_cut(folder, mcap.substr(0, chunks[2] + into));
      EXPECT_EQ(cut.times, (std::vector<Nanoseconds>{1, 2})) << into;
      if (into > 0) {
        EXPECT_NE(cut.left_out.find("its last " + std::to_string(into) + " of "), std::string::npos) << cut.left_out;
      }
    }
    std::string blank = mcap.substr(0, mcap.size() - 1);  // a file whose last bytes never came to the disk
    std::fill(blank.begin() + static_cast<std::ptrdiff_t>(chunks[2] + 40), blank.end(), '\0');
    EXPECT_EQ(read_cut(folder, blank).times, (std::vector<Nanoseconds>{1, 2}));
  }
}

TEST(McapReader, TheChunkThatAFileEndsInGivesItsWholeMessages) {
  const Folder folder;
  for (const char* compression : {"", "zstd", "lz4"}) {
    const std::string file = folder / "whole.mcap";
    constexpr int count = 20;
    {
      const auto writer = make_mcap_writer(file, compression);
      const auto topic = writer->add_topic({"/odom", "nav_msgs/msg/Odometry", "x", ""});
      std::vector<std::uint8_t> message(200'000);
      std::uint32_t noise = 1;
      for (int i = 0; i < count; ++i) {
        for (std::uint8_t& byte : message)
          byte = static_cast<std::uint8_t>((noise = noise * 1664525U + 1013904223U) >> 24U);
        writer->write(topic, i + 1, message);
      }
      writer->finish();
    }
    std::string mcap = bytes(file);
    const std::vector<std::size_t> chunks = without_chunk_times(mcap);
    const std::size_t behind = chunks.size() > 1 ? chunks[1] : mcap.size(), into = (behind - chunks[0]) / 2;
    const std::size_t whole = into / 200'100;
    ASSERT_GE(whole, 2U);
    const Found cut = read_cut(folder, mcap.substr(0, chunks[0] + into));
    // Blocks of compressed data are up to 4 MB; what the last one holds cannot be had.
    EXPECT_GE(cut.times.size(), *compression == '\0' ? whole : std::size_t{1}) << compression;
    EXPECT_LE(cut.times.size(), whole) << compression;
    for (std::size_t i = 0; i < cut.times.size(); ++i) EXPECT_EQ(cut.times[i], static_cast<Nanoseconds>(i + 1));
    EXPECT_EQ(cut.left_out, "the bag was not closed or is cut off; of its last chunk, " + std::to_string(into) +
                                " of " + std::to_string(chunks[0] + into) + " bytes, the first " +
                                std::to_string(cut.times.size()) + " messages are read");
  }
}

TEST(McapReader, AFileOfWhichNothingIsWholeIsRefused) {
  const Folder folder;
  std::string mcap = three_chunks(folder, "");
  const std::size_t first = without_chunk_times(mcap).front();
  for (const std::size_t size : {std::size_t{8}, std::size_t{12}, first, first + 1000})
    EXPECT_NE(input_error([&] { (void)read_cut(folder, mcap.substr(0, size)); }).find("holds no whole message"),
              std::string::npos)
        << size;
  EXPECT_NE(input_error([&] { (void)read_cut(folder, "short"); }).find("is no MCAP file"), std::string::npos);
  std::string long_record = mcap.substr(0, first + 100);
  const std::uint64_t length = std::uint64_t{1} << 60U;
  std::memcpy(&long_record[first + 1], &length, sizeof length);
  EXPECT_NE(input_error([&] { (void)read_cut(folder, long_record); }).find("holds no whole message"),
            std::string::npos);
}

/// The same as a whole file, and as one that was not closed.
TEST(McapReader, ADamagedChunkIsLeftOut) {
  const Folder folder;
  for (const char* compression : {"", "zstd", "lz4"}) {
    std::string mcap = three_chunks(folder, compression);
    std::string copy = mcap;
    const std::vector<std::size_t> chunks = without_chunk_times(copy);
    mcap[chunks[1] + (chunks[2] - chunks[1]) / 2] ^= 1;
    for (const bool closed : {true, false}) {
      const Found found = read_cut(folder, mcap.substr(0, mcap.size() - (closed ? 0 : 1)));
      EXPECT_EQ(found.times, (std::vector<Nanoseconds>{1, 3})) << compression << closed;
      EXPECT_NE(found.left_out.find("damaged chunks are left out: 1 of 3, "), std::string::npos) << found.left_out;
    }
  }
}

TEST(McapReader, AFileWhoseChunksAreAllDamagedIsRefused) {
  const Folder folder;
  std::string mcap = three_chunks(folder, "");
  std::string copy = mcap;
  for (const std::size_t chunk : without_chunk_times(copy)) mcap[chunk + 1000] ^= 1;
  for (const bool closed : {true, false})
    EXPECT_NE(input_error([&] {
                (void)read_cut(folder, mcap.substr(0, mcap.size() - (closed ? 0 : 1)));
              }).find("a chunk whose checksum is wrong"),
              std::string::npos);
}

/// All that are asked for, beside a whole chunk that is not.
TEST(McapReader, AFileWhoseChunksOfATopicAreAllDamagedIsRefused) {
  const Folder folder;
  const std::string file = folder / "two.mcap";
  {
    const auto writer = make_mcap_writer(file, "");
    const auto odometry = writer->add_topic({"/odom", "nav_msgs/msg/Odometry", "x", ""});
    const auto other = writer->add_topic({"/other", "nav_msgs/msg/Odometry", "x", ""});
    for (const auto& [topic, time] : {std::pair(odometry, 1), std::pair(odometry, 2), std::pair(other, 3)})
      writer->write(topic, time, std::vector<std::uint8_t>(2'000'000, 7));
    writer->finish();
  }
  std::string mcap = bytes(file), copy = mcap;
  const std::vector<std::size_t> chunks = without_chunk_times(copy);
  ASSERT_EQ(chunks.size(), 3U);
  for (const std::size_t k : {0U, 1U}) mcap[chunks[k] + 1000] ^= 1;
  EXPECT_NE(input_error([&] { (void)read_cut(folder, mcap); }).find("a chunk whose checksum is wrong"),
            std::string::npos);
}

/// A summary may repeat channels and leave out their schemas.
TEST(McapReader, TypesThatTheSummaryLeavesOutComeFromTheChunks) {
  const Folder folder;
  const std::string mcap = three_chunks(folder, "zstd");
  constexpr std::size_t magic = 8, head = 9, footer = 20;
  const std::size_t footer_at = mcap.size() - magic - head - footer;
  std::uint64_t summary_at = 0;
  std::memcpy(&summary_at, &mcap[footer_at + head], sizeof summary_at);
  std::string changed = mcap.substr(0, summary_at);
  for (std::size_t at = summary_at; at < footer_at;) {
    std::uint64_t size = 0;
    std::memcpy(&size, &mcap[at + 1], sizeof size);
    if (mcap[at] != '\x03') changed += mcap.substr(at, head + size);
    at += head + size;
  }
  std::string end = mcap.substr(footer_at);
  std::fill_n(end.begin() + head + 8, 12, '\0');  // no offsets, no checksum
  ASSERT_LT(changed.size() + end.size(), mcap.size());
  EXPECT_EQ(read_cut(folder, changed + end).times, (std::vector<Nanoseconds>{1, 2, 3}));
  const auto source = open_mcap(folder / "cut.mcap");
  ASSERT_EQ(source->topics().size(), 1U);
  EXPECT_EQ(source->topics()[0].type, open_mcap(folder / "whole.mcap")->topics()[0].type);
}

}  // namespace
}  // namespace plumbline::slam
