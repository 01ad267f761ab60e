// SPDX-License-Identifier: Apache-2.0
#include "slam/io/packets/udp_frame.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "bim/random/stream.h"

namespace plumbline::slam {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// An IPv4 packet with a UDP datagram of three bytes to port 2368, options of 4 bytes in its header.
Bytes ip_packet() {
  return {0x46, 0, 0, 35, 0, 0, 0x40, 0,    64,   17,   0, 0,  10, 0, 0, 1, 10, 0,
          0,    2, 1, 1,  1, 1, 0x12, 0x34, 0x09, 0x40, 0, 11, 0,  0, 7, 8, 9};
}

Bytes joined(Bytes head, const Bytes& tail) {
  head.insert(head.end(), tail.begin(), tail.end());
  return head;
}

void expect_found(const Bytes& frame, Link link) {
  const auto datagram = find_udp(frame, link);
  ASSERT_TRUE(datagram.has_value());
  EXPECT_EQ(datagram->source, 0x0a000001U);
  EXPECT_EQ(datagram->source_port, 0x1234U);
  EXPECT_EQ(datagram->port, 2368U);
  EXPECT_EQ(Bytes(datagram->payload.begin(), datagram->payload.end()), (Bytes{7, 8, 9}));
}

TEST(UdpFrame, IsFoundBehindEveryLinkAndVlanTags) {
  const Bytes macs(12, 1), ip = ip_packet();
  expect_found(ip, Link::raw_ip);
  expect_found(joined(joined(macs, {0x08, 0}), ip), Link::ethernet);
  expect_found(joined(joined(macs, {0x81, 0, 0, 5, 0x08, 0}), ip), Link::ethernet);
  expect_found(joined(joined(macs, {0x88, 0xa8, 0, 5, 0x81, 0, 0, 6, 0x08, 0}), ip), Link::ethernet);
  expect_found(joined(joined(Bytes(14, 0), {0x08, 0}), ip), Link::linux_cooked);
  expect_found(joined(joined({0x08, 0}, Bytes(18, 0)), ip), Link::linux_cooked_2);
}

TEST(UdpFrame, PaddingAfterTheDatagramIsNoPayload) { expect_found(joined(ip_packet(), Bytes(20, 0xaa)), Link::raw_ip); }

TEST(UdpFrame, OtherTrafficIsLeftOut) {
  Bytes fragment = ip_packet();
  fragment[7] = 1;
  EXPECT_FALSE(find_udp(fragment, Link::raw_ip).has_value());
  Bytes tcp = ip_packet();
  tcp[9] = 6;
  EXPECT_FALSE(find_udp(tcp, Link::raw_ip).has_value());
  Bytes six = ip_packet();
  six[0] = 0x60;
  EXPECT_FALSE(find_udp(six, Link::raw_ip).has_value());
  EXPECT_FALSE(find_udp(joined(joined(Bytes(12, 1), {0x86, 0xdd}), ip_packet()), Link::ethernet).has_value());
}

TEST(UdpFrame, AnyBytesAreAnsweredWithinTheFrame) {
  const Stream stream(1, "slam.ransac");
  for (std::uint32_t n = 0; n < 20'000; ++n) {
    Bytes frame(stream.bits(n, 0) % 80);
    for (std::uint32_t i = 0; i < frame.size(); ++i) {
      // Mostly what is expected there, so that the deeper checks are reached.
      const Bytes model = joined(joined(Bytes(12, 1), {0x08, 0}), ip_packet());
      const std::uint64_t draw = stream.bits(n, 1, i);
      frame[i] = draw % 8 != 0 && i < model.size() ? model[i] : static_cast<std::uint8_t>(draw >> 8U);
    }
    const auto datagram = find_udp(frame, Link::ethernet);
    if (!datagram || datagram->payload.empty()) continue;
    EXPECT_GE(datagram->payload.data(), frame.data());
    EXPECT_LE(datagram->payload.data() + datagram->payload.size(), frame.data() + frame.size());
  }
}

}  // namespace
}  // namespace plumbline::slam
