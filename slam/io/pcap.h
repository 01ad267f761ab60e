// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "slam/io/vlp16.h"

namespace plumbline::slam {

/// Reads the VLP-16 data packets (UDP port 2368 over Ethernet) of a pcap capture, in file order; position packets and
/// other traffic are left out. Stamps: a capture of write_pcap gives back its own, to the nanosecond; any other starts
/// at 0 and counts the packets' own microseconds, across full hours. Throws InputError when the file is missing, no
/// capture, cut off, of another link type, or holds no data packet.
[[nodiscard]] std::vector<Vlp16Packet> read_pcap(const std::string& path);

/// Writes packets as the sensor sends them (1,248 bytes each), with nanosecond stamps. The file appears complete or
/// not at all. Throws EnvironmentError when it cannot be written.
void write_pcap(const std::string& path, std::span<const Vlp16Packet> packets);

}  // namespace plumbline::slam
