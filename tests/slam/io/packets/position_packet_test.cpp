// SPDX-License-Identifier: Apache-2.0
#include "slam/io/packets/position_packet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace plumbline::slam {
namespace {

TEST(PositionPacket, SaysTheTimeOfTheRecording) {
  EXPECT_EQ(gprmc_sentence(0), "$GPRMC,000000,A,0000.0000,N,00000.0000,E,000.0,000.0,010120,000.0,E*74");
  EXPECT_EQ(gprmc_sentence(90'061'999'999'999).substr(0, 15), "$GPRMC,010101,A");
  EXPECT_NE(gprmc_sentence(90'061'999'999'999).find(",020120,"), std::string::npos);
}

TEST(PositionPacket, ItsChecksumHolds) {
  for (const Nanoseconds stamp : {0LL, 1'000'000'000LL, 3'599'999'999'999LL, 86'400'000'000'000LL}) {
    const std::string sentence = gprmc_sentence(stamp);
    unsigned sum = 0;
    for (const char c : sentence.substr(1, sentence.size() - 4)) sum ^= static_cast<unsigned char>(c);
    EXPECT_EQ(std::stoul(sentence.substr(sentence.size() - 2), nullptr, 16), sum) << sentence;
  }
}

TEST(PositionPacket, IsLaidOutAsTheManualSays) {
  const auto bytes = position_payload(3'600'000'000'000 + 0x01020304LL * 1000);
  EXPECT_EQ(bytes[198], 0x04);
  EXPECT_EQ(bytes[201], 0x01);
  EXPECT_EQ(bytes[202], 2);
  EXPECT_EQ(std::string(bytes.begin() + 206, bytes.begin() + 213), "$GPRMC,");
  const auto end = std::find(bytes.begin() + 206, bytes.end(), 0);
  EXPECT_EQ(std::string(end - 2, end), "\r\n");
}

}  // namespace
}  // namespace plumbline::slam
