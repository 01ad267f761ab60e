// SPDX-License-Identifier: Apache-2.0
#include "slam/io/bags/bag_check.h"

#include <bzlib.h>
#include <gtest/gtest.h>
#include <lz4frame.h>

#include <cstdint>
#include <fstream>
#include <functional>

#include "bim/config/input_file.h"
#include "bim/errors.h"
#include "bim/formats/mesh/subprocess.h"
#include "bim/random/stream.h"
#include "slam/io/bags/bag.h"
#include "slam/io/bags/bag_source.h"
#include "tests/folder.h"
#include "tests/input_error.h"
#include "tests/slam/io/bags/ros1_bytes.h"
#include "tests/slam/io/packets/packets.h"

namespace plumbline::slam {
namespace {

using ros1_bytes::field;
using ros1_bytes::op;
using ros1_bytes::record;
using ros1_bytes::u32;
using ros1_bytes::u64;

/// Everything that a bag of one chunk says about itself; each value may be spoilt.
struct SmallBag {
  std::string compression = "none";
  LZ4F_preferences_t lz4 = {};
  std::string messages = record(op(7) + field("conn", u32(0)) + field("topic", "/t"), "") +
                         record(op(2) + field("conn", u32(0)) + field("time", u64(5)), "payload");
  std::uint64_t chunk_size = messages.size();
  std::uint64_t offset = 0;
  std::uint64_t index_count = 1;
  std::uint64_t index_pos_shift = 0;
  std::uint64_t chunk_pos_shift = 0;
  std::uint64_t connections = 1, chunks = 1;
  std::string head_fields;
  std::string between;  ///< a record after the chunk's index

  [[nodiscard]] std::string bytes() const {
    std::string packed = messages;
    if (compression == "bz2") {
      auto size = static_cast<unsigned>(messages.size() + 600);
      packed.resize(size);
      std::string from = messages;
      BZ2_bzBuffToBuffCompress(packed.data(), &size, from.data(), static_cast<unsigned>(from.size()), 9, 0, 30);
      packed.resize(size);
    }
    if (compression == "lz4") {
      packed.resize(LZ4F_compressFrameBound(messages.size(), &lz4));
      packed.resize(LZ4F_compressFrame(packed.data(), packed.size(), messages.data(), messages.size(), &lz4));
    }
    const std::string magic = "#ROSBAG V2.0\n";
    const std::string chunk =
        record(op(5) + field("compression", compression) + field("size", u32(chunk_size)), packed);
    const std::string index = record(
        op(4) + field("ver", u32(1)) + field("conn", u32(0)) + field("count", u32(index_count)), u64(5) + u32(offset));
    const auto head = [&](std::uint64_t index_pos) {
      return record(op(3) + field("index_pos", u64(index_pos)) + field("conn_count", u32(connections)) +
                        field("chunk_count", u32(chunks)) + head_fields,
                    std::string(20, ' '));
    };
    const std::uint64_t chunk_pos = magic.size() + head(0).size();
    const std::uint64_t index_pos = chunk_pos + chunk.size() + index.size() + between.size();
    const std::string connection =
        record(op(7) + field("conn", u32(0)) + field("topic", "/t"),
               field("type", "x/Y") + field("md5sum", "0") + field("message_definition", ""));
    const std::string info =
        record(op(6) + field("ver", u32(1)) + field("chunk_pos", u64(chunk_pos + chunk_pos_shift)) +
                   field("start_time", u64(5)) + field("end_time", u64(5)) + field("count", u32(1)),
               u32(0) + u32(1));
    return magic + head(index_pos + index_pos_shift) + chunk + index + between + connection + info;
  }
};

class BagCheck : public ::testing::Test {
 protected:
  std::string write(const std::string& bytes) {
    std::ofstream(folder_ / "x.bag", std::ios::binary) << bytes;
    return folder_ / "x.bag";
  }
  std::string complaint(const std::string& bytes) {
    const std::string path = write(bytes);
    const std::string text = input_error([&] { (void)check_bag(path); });
    return text.rfind(path + ": byte ", 0) == 0 ? text.substr(text.find(": ", path.size() + 2) + 2) : text;
  }
  std::string complaint(const std::function<void(SmallBag&)>& spoil) {
    SmallBag bag;
    spoil(bag);
    return complaint(bag.bytes());
  }
  Folder folder_;
};

TEST_F(BagCheck, WhatFitsPasses) {
  EXPECT_EQ(complaint(SmallBag().bytes()), "no error");
  EXPECT_EQ(complaint([](SmallBag& bag) { bag.compression = "bz2"; }), "no error");
  EXPECT_EQ(complaint([](SmallBag& bag) { bag.between = record(op(99), "what rosbag skips"); }), "no error");
  const std::size_t second = record(op(7) + field("conn", u32(0)) + field("topic", "/t"), "").size();
  EXPECT_EQ(complaint([&](SmallBag& bag) { bag.offset = second; }), "no error");
}

// Others than rosbag write frames with linked blocks, a size or without a checksum; all hold the same.
TEST_F(BagCheck, EveryKindOfLz4FrameIsRead) {
  for (int kind = 0; kind < 16; ++kind) {
    SmallBag bag;
    bag.compression = "lz4";
    const std::string big(200'000, 'b');  // linked blocks are seen from the second on
    bag.messages = record(op(7) + field("conn", u32(0)) + field("topic", "/t"), "") +
                   record(op(2) + field("conn", u32(0)) + field("time", u64(5)), big);
    bag.chunk_size = bag.messages.size();
    bag.lz4.frameInfo.blockMode = (kind & 1) != 0 ? LZ4F_blockIndependent : LZ4F_blockLinked;
    bag.lz4.frameInfo.contentChecksumFlag = (kind & 2) != 0 ? LZ4F_contentChecksumEnabled : LZ4F_noContentChecksum;
    bag.lz4.frameInfo.contentSize = (kind & 4) != 0 ? bag.messages.size() : 0;
    bag.lz4.frameInfo.blockChecksumFlag = (kind & 8) != 0 ? LZ4F_blockChecksumEnabled : LZ4F_noBlockChecksum;
    const std::string path = write(bag.bytes());
    EXPECT_EQ(check_bag(path), kind == 3) << kind;
    const auto source = open_source(path);
    source->select({"/t"});
    std::string all;
    for (RawMessage m; source->next(m);) all.append(m.bytes.begin(), m.bytes.end());
    EXPECT_EQ(all, big) << kind;
    EXPECT_TRUE(source->left_out().empty()) << kind;
  }
}

TEST_F(BagCheck, LengthsThatTheBagDoesNotHoldAreRefused) {
  const std::string magic = "#ROSBAG V2.0\n";
  EXPECT_NE(complaint(magic).find("the bag ends in the middle of a record"), std::string::npos);
  EXPECT_EQ(complaint(magic + u32(0x78787878) + "xxxx"), "a length of 2021161080 bytes where 4 are left");
  const std::string small = SmallBag().bytes();
  for (std::size_t n = magic.size(); n < small.size(); ++n) EXPECT_NE(complaint(small.substr(0, n)), "no error") << n;
  EXPECT_EQ(complaint([](SmallBag& bag) {
              bag.between = u32(0xe0) + std::string(40, 'x');
            }).rfind("a header with a field that is longer", 0),
            0U);
  EXPECT_EQ(complaint([](SmallBag& bag) { bag.chunk_size = 0xffffffff; }),
            "a chunk of 4294967295 bytes; at most 268435456 are read");
  EXPECT_EQ(complaint([](SmallBag& bag) { bag.chunk_size += 1; }).rfind("a chunk of ", 0), 0U);
  EXPECT_EQ(complaint([](SmallBag& bag) {
              bag.compression = "bz2";
              bag.chunk_size += 1;
            }),
            "a chunk that cannot be unpacked");
  EXPECT_EQ(complaint([](SmallBag& bag) {
              bag.compression = "lz4";
              bag.chunk_size += 1;
            }),
            "lz4 data of another size than stated");
  EXPECT_EQ(complaint([](SmallBag& bag) { bag.compression = "zip"; }).rfind("a chunk packed by 'zip'", 0), 0U);
  const auto in_chunk = [](const std::string& messages) {
    return [messages](SmallBag& bag) {
      bag.messages = messages;
      bag.chunk_size = messages.size();
    };
  };
  const std::string header = op(2) + field("conn", u32(0)) + field("time", u64(5));
  EXPECT_EQ(complaint(in_chunk(u32(header.size()) + header + u32(0x40000000) + "payload")),
            "a chunk with a record that is longer than the chunk");
  EXPECT_EQ(complaint(in_chunk(u32(0x40000000) + header + u32(0))),
            "a chunk with a record that is longer than the chunk");
  EXPECT_EQ(complaint(in_chunk(record(op(2) + field("conn", u32(0)), ""))), "a header without 'time'");
  EXPECT_EQ(complaint(in_chunk(record(op(2) + field("conn", "0"), ""))).rfind("a header whose 'conn'", 0), 0U);
}

TEST_F(BagCheck, PlacesWhereNothingIsAreRefused) {
  EXPECT_EQ(complaint([](SmallBag& bag) { bag.offset = 3; }), "an index that points to no message of its chunk");
  EXPECT_EQ(complaint([](SmallBag& bag) { bag.offset = 0xfffffff0; }),
            "an index that points to no message of its chunk");
  EXPECT_EQ(complaint([](SmallBag& bag) { bag.index_count = 0x10000000; }).rfind("an index whose length", 0), 0U);
  EXPECT_EQ(complaint([](SmallBag& bag) { bag.chunk_pos_shift = 1; }), "the place of a chunk where none is");
  EXPECT_EQ(complaint([](SmallBag& bag) { bag.chunks = 2; }), "the bag ends in the middle of its index");
  EXPECT_EQ(complaint([](SmallBag& bag) { bag.connections = 2; }).rfind("a record among the connections", 0), 0U);
  EXPECT_EQ(complaint([](SmallBag& bag) { bag.index_pos_shift = 1; }).rfind("a record that reaches into", 0), 0U);
  EXPECT_NE(complaint([](SmallBag& bag) { bag.index_pos_shift = 1U << 30U; }).find("was not closed or is cut off"),
            std::string::npos);
  EXPECT_NE(complaint([](SmallBag& bag) {
              bag.head_fields = field("encryptor", "rosbag/AesCbcEncryptor");
            }).find("an encrypted bag"),
            std::string::npos);
}

/// A bag of the writer's, spoilt anywhere, is read or refused, in a bounded memory: nothing aborts.
TEST_F(BagCheck, ASpoiltBagNeverAborts) {
  const std::string path = folder_ / "good.bag";
  {
    BagWriter writer(path, bag_profiles[0], Calibration{});
    const std::vector<Vlp16Packet> packets = turning_packets(76);
    const Scan scan = decode_message(packets);
    const std::vector<Odometry> odometry = {{0, Pose{}}, {scan.stamp, Pose{}}};
    writer.add(scan, odometry, {});
    writer.finish();
  }
  EXPECT_EQ(input_error([&] { (void)check_bag(path); }), "no error");
  const std::string good = read_text_file(path);
  const Stream stream(3, "bim.generate");
  int refused = 0;
  constexpr int trials = 150;
  for (int i = 0; i < trials; ++i) {
    std::string bytes = good;
    const auto tick = static_cast<std::uint64_t>(i);
    // Half of them where lengths stand: in the first records and in the index at the end.
    const double where = stream.uniform(tick, 0);
    const std::size_t span = i % 4 == 0 ? 4300 : i % 4 == 1 ? 9000 : bytes.size();
    const std::size_t from = i % 4 == 1 ? bytes.size() - span : 0;
    const std::size_t at = from + static_cast<std::size_t>(where * static_cast<double>(span - 4));
    for (std::size_t k = 0; k < (i % 3 == 0 ? 4U : 1U); ++k)
      bytes[at + k] = static_cast<char>(stream.bits(tick, 1, static_cast<std::uint32_t>(k)) & 0xffU);
    const std::string spoilt = write(bytes);
    bim::SubprocessLimits limits;
    limits.memory = std::uint64_t{512} << 20U;
    const auto answer = bim::run_in_subprocess(
                            [&] {
                              return input_error([&] {
                                const auto recording = open_bag(spoilt, {}, nullptr);
                                for (SensorFrame frame; recording->next(frame);) continue;
                              });
                            },
                            limits)
                            .answer;
    ASSERT_TRUE(answer) << "byte " << at << " of trial " << i << " ended the process";
    refused += *answer == "no error" ? 0 : 1;
  }
  EXPECT_GT(refused, trials / 4);
}

}  // namespace
}  // namespace plumbline::slam
