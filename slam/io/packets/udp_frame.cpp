// SPDX-License-Identifier: Apache-2.0
#include "slam/io/packets/udp_frame.h"

#include <algorithm>
#include <cstddef>

namespace plumbline::slam {

namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr unsigned ipv4_type = 0x0800;
constexpr unsigned vlan_type = 0x8100;
constexpr unsigned service_vlan_type = 0x88a8;
constexpr std::uint8_t udp_protocol = 17;
constexpr std::size_t ip_bytes = 20;
constexpr std::size_t udp_bytes = 8;

unsigned big16(const std::uint8_t* p) { return (static_cast<unsigned>(p[0]) << 8U) | p[1]; }

/// The IP packet of a frame whose type stands at `type_at` and whose content at `content`; VLAN tags lie between.
std::optional<Bytes> ip_packet(Bytes frame, std::size_t type_at, std::size_t content) {
  while (frame.size() >= content && type_at + 2 <= frame.size()) {
    const unsigned type = big16(&frame[type_at]);
    if (type == ipv4_type) return frame.subspan(content);
    if (type != vlan_type && type != service_vlan_type) return std::nullopt;
    type_at = content + 2;
    content += 4;
  }
  return std::nullopt;
}

std::optional<Bytes> ip_packet(Bytes frame, Link link) {
  switch (link) {
    case Link::ethernet:
      return ip_packet(frame, 12, 14);
    case Link::linux_cooked:
      return ip_packet(frame, 14, 16);
    case Link::linux_cooked_2:
      return ip_packet(frame, 0, 20);
    case Link::raw_ip:
      return frame;
  }
  return std::nullopt;
}

}  // namespace

std::optional<UdpDatagram> find_udp(Bytes frame, Link link) {
  const std::optional<Bytes> ip = ip_packet(frame, link);
  if (!ip || ip->size() < ip_bytes || (*ip)[0] >> 4U != 4 || (*ip)[9] != udp_protocol) return std::nullopt;
  const bool later_fragment = (big16(&(*ip)[6]) & 0x1fffU) != 0;
  const std::size_t header = 4 * ((*ip)[0] & 0x0fU);
  if (later_fragment || header < ip_bytes || ip->size() < header + udp_bytes) return std::nullopt;
  const Bytes udp = ip->subspan(header);
  const std::size_t length = big16(&udp[4]);
  if (length < udp_bytes) return std::nullopt;
  const std::uint32_t source = (big16(&(*ip)[12]) << 16U) | big16(&(*ip)[14]);
  return UdpDatagram{source, big16(&udp[0]), big16(&udp[2]),
                     udp.subspan(udp_bytes, std::min(length, udp.size()) - udp_bytes)};
}

}  // namespace plumbline::slam
