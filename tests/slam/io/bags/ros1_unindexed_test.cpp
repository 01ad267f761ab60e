// SPDX-License-Identifier: Apache-2.0
#include "slam/io/bags/ros1_unindexed.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "bim/errors.h"
#include "bim/random/stream.h"
#include "slam/io/bags/bag.h"
#include "slam/io/bags/bag_source.h"
#include "tests/folder.h"
#include "tests/input_error.h"
#include "tests/slam/io/bags/bag_of_four_scans.h"
#include "tests/slam/io/bags/ros1_bytes.h"

namespace plumbline::slam {
namespace {

using ros1_bytes::field;
using ros1_bytes::op;
using ros1_bytes::raw;
using ros1_bytes::record;
using ros1_bytes::u32;
using ros1_bytes::u64;

/// The bag's head with an index at 0, as while a bag is being written.
std::string open_head() {
  return "#ROSBAG V2.0\n" +
         record(op(3) + field("index_pos", u64(0)) + field("conn_count", u32(0)) + field("chunk_count", u32(0)),
                std::string(20, ' '));
}
std::string connection(const std::string& topic) {
  return record(op(7) + field("conn", u32(0)) + field("topic", topic), field("type", "x/Y") + field("md5sum", "0"));
}
std::string message(std::uint32_t s, std::uint32_t ns, const std::string& data) {
  return record(op(2) + field("conn", u32(0)) + field("time", raw(s) + raw(ns)), data);
}
std::string chunk(const std::string& records) {
  return record(op(5) + field("compression", "none") + field("size", u32(records.size())), records);
}

class UnindexedBagTest : public ::testing::Test {
 protected:
  std::string write(const std::string& bytes) {
    std::ofstream(folder_ / "x.bag", std::ios::binary) << bytes;
    return folder_ / "x.bag";
  }
  /// "time:data" of its messages, and what is left out.
  std::string read(const std::string& bytes) {
    const auto source = open_source(write(bytes));
    source->select({"/t"});
    std::string all;
    for (RawMessage m; source->next(m);)
      all += std::to_string(m.time) + ":" + std::string(m.bytes.begin(), m.bytes.end()) + " ";
    return all + (source->left_out().empty() ? "" : source->left_out().front());
  }
  Folder folder_;
};

TEST_F(UnindexedBagTest, GivesWholeMessagesInTheOrderOfTime) {
  const std::string two = chunk(connection("/t") + message(1, 5, "b") + message(0, 7, "a"));
  EXPECT_EQ(read(open_head() + two),
            "7:a 1000000005:b the bag was not closed or is cut off; all that it holds is read");
  const std::string all = open_head() + two + chunk(message(2, 0, "c"));
  EXPECT_EQ(read(all).find("7:a 1000000005:b 2000000000:c"), 0U);
  const std::size_t last = chunk(message(2, 0, "c")).size();
  for (std::size_t missing = 1; missing < last; ++missing) {
    const std::string left = "its last " + std::to_string(last - missing) + " of ";
    const std::string said = read(all.substr(0, all.size() - missing));
    EXPECT_EQ(said.find("7:a 1000000005:b the bag"), 0U) << said;
    EXPECT_NE(said.find(left), std::string::npos) << said;
  }
}

TEST_F(UnindexedBagTest, TakesWhatTheChunkHoldsThatWasBeingWritten) {
  const std::string open_chunk = chunk("") + connection("/t") + message(0, 1, "a") + message(0, 2, "b");
  EXPECT_EQ(read(open_head() + open_chunk).find("1:a 2:b the bag"), 0U);
  EXPECT_NE(read(open_head() + open_chunk + message(0, 3, "cut").substr(0, 20)).find("its last 20 of "),
            std::string::npos);
}

TEST_F(UnindexedBagTest, DamagedChunksAreLeftOut) {
  const std::string good = chunk(connection("/t") + message(0, 1, "a")), bad = chunk("no records");
  EXPECT_EQ(read(open_head() + good + bad).find("1:a the bag was not closed or is cut off; its last "), 0U);
  const std::string all = open_head() + good + bad + chunk(message(0, 2, "b"));
  EXPECT_EQ(read(all), "1:a 2:b the bag was not closed or is cut off, and is damaged; " + std::to_string(bad.size()) +
                           " of its " + std::to_string(all.size()) +
                           " bytes cannot be read and are left out, the first at byte " +
                           std::to_string(open_head().size() + good.size()) +
                           ": a chunk with a record that is longer than the chunk");
}

TEST_F(UnindexedBagTest, TheLastChunkIsReadAsFarAsItIsThere) {
  const std::string last = chunk(message(0, 2, "b") + message(0, 3, "c"));
  const std::string all = open_head() + chunk(connection("/t") + message(0, 1, "a")) + last;
  EXPECT_EQ(read(all.substr(0, all.size() - 1))
                .find("1:a 2:b the bag was not closed or is cut off; its last " +
                      std::to_string(message(0, 3, "c").size() - 1) + " of "),
            0U);
}

/// A closed bag of chunks with one message each.
struct ClosedBag {
  std::vector<std::string> chunks = {chunk(connection("/t") + message(0, 1, "a")), chunk(message(0, 2, "b")),
                                     chunk(message(0, 3, "c"))};

  /// spoil: what is done to the chunks when all else is written.
  template <class F>
  [[nodiscard]] std::string bytes(const F& spoil) const {
    const auto head = [&](std::uint64_t index_at) {
      return "#ROSBAG V2.0\n" + record(op(3) + field("index_pos", u64(index_at)) + field("conn_count", u32(1)) +
                                           field("chunk_count", u32(chunks.size())),
                                       std::string(20, ' '));
    };
    std::string data, infos;
    for (const std::string& one : chunks) {
      infos += record(op(6) + field("ver", u32(1)) + field("chunk_pos", u64(head(0).size() + data.size())) +
                          field("start_time", u64(1)) + field("end_time", u64(1)) + field("count", u32(1)),
                      u32(0) + u32(1));
      data +=
          one + record(op(4) + field("ver", u32(1)) + field("conn", u32(0)) + field("count", u32(1)), u64(1) + u32(0));
    }
    const std::uint64_t index_at = head(0).size() + data.size();
    spoil(data);
    return head(index_at) + data + connection("/t") + infos;
  }
};

TEST_F(UnindexedBagTest, AClosedBagWithADamagedChunkGivesTheOthers) {
  const ClosedBag bag;
  const std::size_t first = bag.chunks[0].size();
  // In turn: the record that tells of the connection; a message; the length of a chunk's header.
  EXPECT_EQ(read(bag.bytes([](std::string& data) { data[data.find("op=\x07")] = '?'; })).find("2:b 3:c the bag is "),
            0U);
  const std::string said = read(bag.bytes([&](std::string& data) { data[data.find("op=\x02", first)] = '?'; }));
  EXPECT_EQ(said.find("1:a 3:c the bag is damaged; " + std::to_string(bag.chunks[1].size()) + " of its "), 0U) << said;
  EXPECT_NE(said.find(" bytes cannot be read and are left out, the first at byte "), std::string::npos) << said;
  const std::string long_header =
      read(bag.bytes([&](std::string& data) { data[data.find("op=\x05", first) - 5] = '\x7f'; }));
  EXPECT_EQ(long_header.find("1:a 3:c the bag is damaged; "), 0U) << long_header;
}

TEST_F(UnindexedBagTest, LengthsThatTheBagDoesNotHoldAreTheEnd) {
  const std::string good = chunk(connection("/t") + message(0, 1, "a"));
  EXPECT_EQ(read(open_head() + good + u32(0xFFFFFFF0U) + "xxxx").find("1:a the bag"), 0U);
  const std::string huge = record(op(5) + field("compression", "lz4") + field("size", u32(0x0FFFFFFFU)), "1234");
  EXPECT_EQ(read(open_head() + good + huge).find("1:a the bag"), 0U);
  for (const std::string& nothing : {std::string(), huge, std::string(40, '\0')})
    EXPECT_NE(input_error([&] { (void)read(open_head() + nothing); }).find("without a whole message"),
              std::string::npos);
}

TEST_F(UnindexedBagTest, ACutBagGivesTheScansThatItHolds) {
  const std::string path = folder_ / "whole.bag";
  write_walk(path, BagFormat::ros1);
  std::ifstream stream(path, std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(stream), {}};
  const auto scans_of = [&](const std::string& file) {
    const auto recording = open_bag(file, {}, nullptr);
    std::vector<Scan> scans;
    for (SensorFrame frame; recording->next(frame);) scans.push_back(frame.scan);
    return scans;
  };
  const std::vector<Scan> all = scans_of(path);
  const std::vector<Scan> cut = scans_of(write(whole.substr(0, whole.size() - 40)));
  ASSERT_EQ(cut.size(), all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(cut[i].stamp, all[i].stamp);
    EXPECT_EQ(cut[i].range_m, all[i].range_m);
  }
}

// Cut anywhere or with any byte altered, it is read or refused.
TEST_F(UnindexedBagTest, DamageIsNoCrash) {
  const std::string path = folder_ / "whole.bag";
  write_walk(path, BagFormat::ros1);
  std::ifstream stream(path, std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(stream), {}};
  const Stream random(3, "bim.generate");
  std::uint64_t draws = 0;
  const auto below = [&](std::size_t n) {
    return static_cast<std::size_t>(random.uniform(draws++) * static_cast<double>(n));
  };
  for (int i = 0; i < 200; ++i) {
    std::string bytes = whole.substr(0, below(whole.size()));
    for (std::size_t k = below(4); k > 0 && !bytes.empty(); --k)
      bytes[below(bytes.size())] = static_cast<char>(below(256));
    const std::string file = write(bytes);
    (void)input_error([&] {
      const auto source = open_unindexed_bag(file, [](const auto&, auto) { return Encoding::ros1; });
      source->select({"/velodyne_points"});
      for (RawMessage m; source->next(m);) {
      }
    });
  }
}

}  // namespace
}  // namespace plumbline::slam
