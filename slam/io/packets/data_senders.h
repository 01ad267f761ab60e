// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "slam/io/packets/udp_frame.h"

namespace plumbline::slam {

/// Whether this is a data packet of a known Velodyne LiDAR, by its size, first flag and product.
[[nodiscard]] bool is_velodyne_data(const UdpDatagram& datagram);

/// Keeps the LiDARs apart whose data packets are in one capture: the first that sends to the port is read.
class DataSenders {
 public:
  /// Whether this datagram is of the LiDAR that is read. Others to the port, and data packets to other ones, are
  /// counted.
  [[nodiscard]] bool take(const UdpDatagram& datagram, unsigned port);
  /// How many came of others, a sentence for each of them.
  [[nodiscard]] std::vector<std::string> left_out() const;

 private:
  struct Sender {
    std::uint32_t address = 0;
    unsigned from_port = 0, to_port = 0;
    auto operator<=>(const Sender&) const = default;
  };
  [[nodiscard]] static std::string text(const Sender& sender);

  std::optional<Sender> read_;
  std::map<Sender, std::int64_t> others_;
  std::int64_t more_ = 0;  ///< of further others
};

}  // namespace plumbline::slam
