// SPDX-License-Identifier: Apache-2.0
// Looks at a capture of ours as a decoder of somebody else's would: bytes only, by the manual, with nothing of our
// reader.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "slam/io/packets/pcap.h"
#include "tests/slam/io/packets/packets.h"

namespace plumbline::slam {
namespace {

namespace fs = std::filesystem;

/// Reads numbers off a file's bytes.
struct Bytes {
  std::vector<unsigned char> data;

  [[nodiscard]] std::uint32_t little(std::size_t at, int bytes) const {
    std::uint32_t value = 0;
    for (int i = bytes; i-- > 0;) value = (value << 8U) | data.at(at + static_cast<std::size_t>(i));
    return value;
  }
  /// Where the frames of data packets start; every record must be one or a position packet.
  [[nodiscard]] std::vector<std::size_t> data_frames() const {
    std::vector<std::size_t> frames;
    for (std::size_t at = 24; at < data.size();) {
      const std::uint32_t size = little(at + 8, 4);
      EXPECT_LT(little(at + 4, 4), 1'000'000'000U);
      EXPECT_EQ(little(at + 12, 4), size);
      EXPECT_TRUE(size == 1248 || (size == 554 && big(at + 16 + 36, 2) == 8308)) << size;
      if (size == 1248) frames.push_back(at + 16);
      at += 16 + size;
    }
    return frames;
  }
  [[nodiscard]] std::uint32_t big(std::size_t at, int bytes) const {
    std::uint32_t value = 0;
    for (int i = 0; i < bytes; ++i) value = (value << 8U) | data.at(at + static_cast<std::size_t>(i));
    return value;
  }
};

Bytes capture_of(const std::vector<Vlp16Packet>& packets) {
  const fs::path path = fs::temp_directory_path() / ("plumbline_capture_" + std::to_string(::getpid()) + ".pcap");
  write_pcap(path.string(), packets);
  std::ifstream file(path, std::ios::binary);
  Bytes bytes{{std::istreambuf_iterator<char>(file), {}}};
  fs::remove(path);
  return bytes;
}

TEST(CaptureCheck, FileAndRecordHeaders) {
  const Bytes bytes = capture_of(turning_packets(20));
  EXPECT_EQ(bytes.little(0, 4), 0xa1b23c4dU);  // nanoseconds, little endian
  EXPECT_EQ(bytes.little(4, 2), 2U);
  EXPECT_EQ(bytes.little(6, 2), 4U);
  EXPECT_EQ(bytes.little(20, 4), 1U);  // Ethernet
  EXPECT_EQ(bytes.data_frames().size(), 20U);
}

TEST(CaptureCheck, EthernetIpAndUdp) {
  const Bytes bytes = capture_of(turning_packets(3));
  for (const std::size_t at : bytes.data_frames()) {
    EXPECT_EQ(bytes.big(at + 12, 2), 0x0800U);
    const std::size_t ip = at + 14;
    EXPECT_EQ(bytes.big(ip, 1), 0x45U);
    EXPECT_EQ(bytes.big(ip + 2, 2), 1248U - 14U);
    EXPECT_EQ(bytes.big(ip + 9, 1), 17U);
    EXPECT_EQ(bytes.big(ip + 12, 4), 0xc0a801c9U);  // 192.168.1.201
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < 20; i += 2) sum += bytes.big(ip + i, 2);
    EXPECT_EQ((sum & 0xffffU) + (sum >> 16U), 0xffffU);
    EXPECT_EQ(bytes.big(ip + 20, 2), 2368U);
    EXPECT_EQ(bytes.big(ip + 22, 2), 2368U);
    EXPECT_EQ(bytes.big(ip + 24, 2), 1206U + 8U);
  }
}

TEST(CaptureCheck, BlocksFactoryBytesAzimuthsAndTimesAcrossTheHour) {
  const Bytes bytes = capture_of(turning_packets(200, 3'599'900'000'000));
  std::uint32_t last_azimuth = 0, last_us = 0;
  bool first = true, wrapped = false;
  for (const std::size_t frame : bytes.data_frames()) {
    const std::size_t at = frame + 42;
    for (std::size_t block = at; block < at + 1200; block += 100) {
      EXPECT_EQ(bytes.big(block, 2), 0xffeeU);
      const std::uint32_t azimuth = bytes.little(block + 2, 2);
      EXPECT_LT(azimuth, 36000U);
      // 600 rpm: 39.8 hundredths a block, rounded.
      const std::uint32_t step = (azimuth + 36000U - last_azimuth) % 36000U;
      if (!first || block > at) {
        EXPECT_TRUE(step == 39 || step == 40) << step;
      }
      last_azimuth = azimuth;
    }
    const std::uint32_t us = bytes.little(at + 1200, 4);
    EXPECT_LT(us, 3'600'000'000U);
    if (!first) {
      const std::uint32_t step = us > last_us ? us - last_us : us + 3'600'000'000U - last_us;
      EXPECT_TRUE(step == 1327 || step == 1328) << step;
      wrapped |= us < last_us;
    }
    last_us = us;
    EXPECT_EQ(bytes.little(at + 1204, 1), 0x37U);  // strongest
    EXPECT_EQ(bytes.little(at + 1205, 1), 0x22U);  // VLP-16
    first = false;
  }
  EXPECT_TRUE(wrapped);
}

}  // namespace
}  // namespace plumbline::slam
