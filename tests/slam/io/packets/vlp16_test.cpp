// SPDX-License-Identifier: Apache-2.0
#include "slam/io/packets/vlp16.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bim/errors.h"
#include "bim/random/stream.h"

namespace plumbline::slam {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

/// Packets of a sensor that turns by step_cdeg a block, with random returns.
std::vector<Vlp16Packet> random_packets(int count, int first_cdeg, int step_cdeg, Nanoseconds start) {
  const Stream stream(3, "bim.generate");
  std::vector<Vlp16Packet> packets;
  for (int p = 0; p < count; ++p) {
    std::array<Vlp16Firing, 24> firings;
    for (int f = 0; f < 24; ++f) {
      const int index = p * 24 + f;
      Vlp16Firing& firing = firings[static_cast<std::size_t>(f)];
      firing.azimuth_cdeg = static_cast<std::uint16_t>((first_cdeg + index / 2 * step_cdeg) % 36000);
      for (std::uint32_t k = 0; k < 16; ++k) {
        const std::uint64_t bits = stream.bits(static_cast<std::uint64_t>(index), k);
        firing.distance[k] = bits % 5 == 0 ? 0 : static_cast<std::uint16_t>(bits >> 48U);
        firing.reflectivity[k] = static_cast<std::uint8_t>(bits >> 8U);
      }
    }
    packets.push_back(encode_packet(start + p * 24 * vlp16::firing_period_ns, firings));
  }
  return packets;
}

TEST(Vlp16, TablesFollowTheManual) {
  for (int k = 0; k < 16; ++k) {
    EXPECT_EQ(vlp16::elevation_deg(k), k % 2 == 0 ? -15 + k : k);
    EXPECT_EQ(vlp16::ring_of_laser(k), static_cast<int>((vlp16::elevation_deg(k) + 15.0) / 2.0));
    // The manual's offsets are 41.91 mm tan(-elevation), rounded to 0.1 mm.
    EXPECT_NEAR(vlp16::vertical_offset_m(k), -0.04191 * std::tan(vlp16::elevation_deg(k) * degree), 0.6e-4);
    EXPECT_NEAR(vlp16::cos_elevation(k), std::cos(vlp16::elevation_deg(k) * degree), 2e-16);
    EXPECT_NEAR(vlp16::sin_elevation(k), std::sin(vlp16::elevation_deg(k) * degree), 2e-16);
  }
}

TEST(Vlp16, PayloadIsLaidOutAsTheManualSays) {
  std::array<Vlp16Firing, 24> firings;
  firings[3].distance[5] = 0x1234;
  firings[3].reflectivity[5] = 77;
  firings[22].azimuth_cdeg = 0x4321;
  const Vlp16Packet packet = encode_packet(3'600'000'000'000 + 0x01020304LL * 1000 + 999, firings);
  EXPECT_EQ(packet.payload[0], 0xff);
  EXPECT_EQ(packet.payload[1], 0xee);
  const std::size_t at = 100 + 4 + 48 + 15;
  EXPECT_EQ(packet.payload[at], 0x34);
  EXPECT_EQ(packet.payload[at + 1], 0x12);
  EXPECT_EQ(packet.payload[at + 2], 77);
  EXPECT_EQ(packet.payload[1102], 0x21);
  EXPECT_EQ(packet.payload[1103], 0x43);
  EXPECT_EQ(packet.payload[1200], 0x04);
  EXPECT_EQ(packet.payload[1203], 0x01);
  EXPECT_EQ(packet.payload[1204], 0x37);
  EXPECT_EQ(packet.payload[1205], 0x22);
}

TEST(Vlp16, DecodesWhatWasEncoded) {
  constexpr int step_cdeg = 40;
  constexpr int first_cdeg = 35990;  // the turn wraps inside the first packet
  const std::vector<Vlp16Packet> packets = random_packets(3, first_cdeg, step_cdeg, 5'000'000'000);
  const Scan scan = decode_message(packets);
  ASSERT_EQ(scan.columns, 72);
  ASSERT_EQ(scan.size(), 72U * 16U);
  const Stream stream(3, "bim.generate");
  for (int column = 0; column < scan.columns; ++column) {
    for (int k = 0; k < 16; ++k) {
      const auto slot = static_cast<std::size_t>(column * 16 + vlp16::ring_of_laser(k));
      const std::uint64_t bits = stream.bits(static_cast<std::uint64_t>(column), static_cast<std::uint32_t>(k));
      const auto distance = bits % 5 == 0 ? std::uint64_t{0} : bits >> 48U;
      const double range = static_cast<double>(distance) * 0.002;
      EXPECT_EQ(scan.range_m[slot], range);
      EXPECT_EQ(scan.stamp + scan.offset_ns[slot], 5'000'000'000 + column * 55296LL + k * 2304LL);
      if (distance == 0) {
        EXPECT_TRUE(scan.point_L[slot].isZero());
        continue;
      }
      EXPECT_EQ(scan.reflectivity[slot], static_cast<float>((bits >> 8U) & 0xffU));
      const double azimuth = degree * 0.01 * (first_cdeg + step_cdeg * (column * 55.296 + k * 2.304) / 110.592);
      const double elevation = degree * vlp16::elevation_deg(k);
      const Eigen::Vector3d expected(range * std::cos(elevation) * std::cos(azimuth),
                                     -range * std::cos(elevation) * std::sin(azimuth),
                                     range * std::sin(elevation) + vlp16::vertical_offset_m(k));
      // 1e-12 rad of azimuth (twenty turns in doubles) at 131 m.
      EXPECT_LT((scan.point_L[slot] - expected).norm(), 1e-10);
    }
  }
}

TEST(Vlp16, StampIsTheLastReturnSlot) {
  const Scan scan = decode_message(random_packets(2, 0, 40, 1'000));
  EXPECT_EQ(scan.stamp, 1'000 + 47 * 55296 + 15 * 2304);
  EXPECT_EQ(scan.offset_ns.back(), 0);
  for (const std::int32_t offset : scan.offset_ns) EXPECT_LE(offset, 0);
}

TEST(Vlp16, VerticalOffsetsAreASwitch) {
  const std::vector<Vlp16Packet> packets = random_packets(1, 0, 40, 0);
  const Scan with = decode_message(packets, true);
  const Scan without = decode_message(packets, false);
  for (std::size_t slot = 0; slot < with.size(); ++slot) {
    if (with.range_m[slot] == 0.0) continue;
    EXPECT_NEAR(without.point_L[slot].norm(), without.range_m[slot], 1e-12 * (1.0 + without.range_m[slot]));
    const double elevation = -15.0 + 2.0 * static_cast<double>(slot % 16);
    EXPECT_NEAR((with.point_L[slot] - without.point_L[slot]).z(), -0.04191 * std::tan(elevation * degree), 0.6e-4);
  }
}

/// One packet of random words of any model and mode; the head turns by 0.2 degrees a firing from azimuth 350 on.
struct RandomPacket {
  RandomPacket(LidarModelId id, ReturnMode mode) : model(lidar_model(id)) {
    const Stream stream(7, "bim.generate");
    const auto firings = static_cast<std::size_t>(firings_in_packet(model, mode));
    for (std::size_t f = 0; f < firings; ++f)
      azimuth_cdeg.push_back(static_cast<std::uint16_t>((35000 + 20 * f) % 36000));
    const auto draw = [&](std::uint32_t lane) {
      std::vector<ReturnWord> words;
      for (std::size_t i = 0; i < firings * model.lasers.size(); ++i) {
        const std::uint64_t bits = stream.bits(i, lane);
        words.push_back(
            {bits % 7 == 0 ? 0U : static_cast<std::uint16_t>(bits >> 48U), static_cast<std::uint8_t>(bits)});
      }
      return words;
    };
    words = draw(0);
    if (mode == ReturnMode::dual) last = draw(1);
    encode_packet(model, mode, 1'000'000, azimuth_cdeg, words, last, packet);
  }
  const LidarModel& model;
  std::vector<std::uint16_t> azimuth_cdeg;
  std::vector<ReturnWord> words, last;
  Vlp16Packet packet;
};

TEST(Velodyne, EveryModelAndModeComesBackAsItWasSent) {
  for (const LidarModelId id : {LidarModelId::vlp16, LidarModelId::vlp32c, LidarModelId::hdl32e})
    for (const ReturnMode mode : {ReturnMode::strongest, ReturnMode::last, ReturnMode::dual}) {
      const RandomPacket sent(id, mode);
      EXPECT_EQ(packet_kind(sent.packet).model, &sent.model);
      EXPECT_EQ(packet_kind(sent.packet).mode, mode);
      const bool dual = mode == ReturnMode::dual;
      const Scan scan = decode_message(std::span(&sent.packet, 1));
      const Scan last = decode_message(std::span(&sent.packet, 1), true, ReturnMode::last);
      const std::size_t lasers = sent.model.lasers.size();
      ASSERT_EQ(scan.size(), sent.words.size());
      for (std::size_t i = 0; i < sent.words.size(); ++i) {
        const Laser& laser = sent.model.lasers[i % lasers];
        const std::size_t slot = i / lasers * lasers + static_cast<std::size_t>(laser.ring);
        const bool take_last = dual && !seems_stronger(sent.words[i], sent.last[i]);
        const ReturnWord& word = take_last ? sent.last[i] : sent.words[i];
        EXPECT_EQ(scan.range_m[slot], word.distance * sent.model.range_unit_m);
        EXPECT_EQ(last.range_m[slot], (dual ? sent.last[i] : sent.words[i]).distance * sent.model.range_unit_m);
        EXPECT_EQ(scan.stamp + scan.offset_ns[slot],
                  1'000'000 + static_cast<Nanoseconds>(i / lasers) * sent.model.firing_period_ns + laser.time_ns);
        if (word.distance == 0) continue;
        EXPECT_EQ(scan.reflectivity[slot], word.reflectivity);
        const double turned =
            0.2 * static_cast<double>(laser.time_ns) / static_cast<double>(sent.model.firing_period_ns);
        const double azimuth = degree * (350.0 + 0.2 * static_cast<double>(i / lasers) + turned + laser.azimuth_deg);
        const Eigen::Vector3d expected(scan.range_m[slot] * laser.cosine * std::cos(azimuth),
                                       -scan.range_m[slot] * laser.cosine * std::sin(azimuth),
                                       scan.range_m[slot] * laser.sine + laser.height_m);
        EXPECT_LT((scan.point_L[slot] - expected).norm(), 1e-9);
      }
    }
}

TEST(Velodyne, DualBlocksComeInPairsTheLastReturnsFirst) {
  const RandomPacket sent(LidarModelId::vlp16, ReturnMode::dual);
  const auto& bytes = sent.packet.payload;
  EXPECT_EQ(bytes[1204], 0x39);
  for (std::size_t block = 0; block < 12; block += 2) {
    EXPECT_EQ(bytes[100 * block + 2], bytes[100 * (block + 1) + 2]);
    EXPECT_EQ(bytes[100 * block + 3], bytes[100 * (block + 1) + 3]);
    EXPECT_EQ(bytes[100 * block + 4] + 256U * bytes[100 * block + 5], sent.last[16 * block].distance);
    EXPECT_EQ(bytes[100 * block + 104] + 256U * bytes[100 * block + 105], sent.words[16 * block].distance);
  }
}

TEST(Velodyne, RefusesToMixSensorsAndModes) {
  const Vlp16Packet strongest = RandomPacket(LidarModelId::vlp16, ReturnMode::strongest).packet;
  for (const auto& other :
       {RandomPacket(LidarModelId::vlp16, ReturnMode::dual), RandomPacket(LidarModelId::vlp32c, ReturnMode::strongest)})
    EXPECT_THROW((void)decode_message(std::vector<Vlp16Packet>{strongest, other.packet}), InputError);
}

TEST(Velodyne, AModelWithoutPacketsGivesTheSameScanFromItsWords) {
  const RandomPacket sent(LidarModelId::vlp32c, ReturnMode::strongest);
  std::vector<double> azimuth;
  for (const std::uint16_t cdeg : sent.azimuth_cdeg) azimuth.push_back(0.01 * degree * cdeg);
  const Scan direct = scan_of_words(sent.model, 1'000'000, azimuth, sent.words);
  const Scan decoded = decode_message(std::span(&sent.packet, 1));
  EXPECT_EQ(direct.stamp, decoded.stamp);
  EXPECT_EQ(direct.offset_ns, decoded.offset_ns);
  EXPECT_EQ(direct.range_m, decoded.range_m);
  EXPECT_THROW(encode_packet(lidar_model(LidarModelId::os1_64), ReturnMode::strongest, 0, {}, {}, {},
                             std::vector<Vlp16Packet>(1)[0]),
               InternalError);
}

TEST(Vlp16, RefusesForeignPackets) {
  EXPECT_THROW((void)decode_message({}), InputError);
  for (const std::size_t byte : {std::size_t{0}, std::size_t{501}, std::size_t{1204}, std::size_t{1205}}) {
    std::vector<Vlp16Packet> packets = random_packets(2, 0, 40, 0);
    packets[1].payload[byte] ^= 0x41U;
    EXPECT_THROW((void)decode_message(packets), InputError) << "byte " << byte;
  }
  std::vector<Vlp16Packet> packets = random_packets(1, 0, 40, 0);
  packets[0].payload[3] = 0xff;  // azimuth above 360 degrees
  EXPECT_THROW((void)decode_message(packets), InputError);
  std::array<Vlp16Firing, 24> firings;
  firings[0].azimuth_cdeg = 36000;
  EXPECT_THROW((void)encode_packet(0, firings), InternalError);
}

}  // namespace
}  // namespace plumbline::slam
