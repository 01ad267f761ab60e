// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bim/random/stream.h"
#include "slam/io/packets/pcap.h"
#include "slam/io/packets/vlp16.h"

namespace plumbline::slam {

/// Packets of a sensor that turns at 600 rpm, without gap from `start` on; most returns are there, anywhere up to 20 m.
inline std::vector<Vlp16Packet> turning_packets(int count, Nanoseconds start = 0) {
  const Stream stream(7, "slam.ransac");
  std::vector<Vlp16Packet> packets;
  for (int p = 0; p < count; ++p) {
    std::array<Vlp16Firing, 24> firings;
    for (int f = 0; f < 24; ++f) {
      Vlp16Firing& firing = firings[static_cast<std::size_t>(f)];
      const std::int64_t column = 24LL * p + f;
      firing.azimuth_cdeg = static_cast<std::uint16_t>(column * vlp16::firing_period_ns * 36 / 100'000 % 36000);
      for (std::size_t k = 0; k < 16; ++k) {
        const double u = stream.uniform(static_cast<std::uint64_t>(column), static_cast<std::uint32_t>(k));
        firing.distance[k] = u < 0.15 ? std::uint16_t{0} : static_cast<std::uint16_t>(10000.0 * u);
        firing.reflectivity[k] = static_cast<std::uint8_t>(255.0 * u);
      }
    }
    packets.push_back(encode_packet(start + p * 24 * vlp16::firing_period_ns, firings));
  }
  return packets;
}

/// All packets of a capture.
inline std::vector<Vlp16Packet> read_pcap(const std::string& path) {
  PcapReader reader(path);
  std::vector<Vlp16Packet> packets;
  for (Vlp16Packet packet; reader.next(packet);) packets.push_back(packet);
  return packets;
}

/// A capture of these packets.
inline void write_pcap(const std::string& path, std::span<const Vlp16Packet> packets) {
  PcapWriter writer(path);
  for (const Vlp16Packet& packet : packets) writer.add(packet);
  writer.finish();
}

}  // namespace plumbline::slam
