// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace plumbline::slam {

/// What precedes the IP packet in a captured frame.
enum class Link { ethernet, linux_cooked, linux_cooked_2, raw_ip };

/// A UDP datagram inside a captured frame.
struct UdpDatagram {
  std::uint32_t source = 0;               ///< IPv4 address of the sender
  unsigned source_port = 0;               ///< and its port
  unsigned port = 0;                      ///< destination
  std::span<const std::uint8_t> payload;  ///< as far as it was captured
};

/// The datagram of an IPv4 frame, VLAN tags skipped; nothing where the frame is cut off before its payload, is a later
/// fragment, or carries anything else.
[[nodiscard]] std::optional<UdpDatagram> find_udp(std::span<const std::uint8_t> frame, Link link);

}  // namespace plumbline::slam
