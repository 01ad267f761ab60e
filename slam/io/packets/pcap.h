// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "slam/io/packets/vlp16.h"

namespace plumbline::slam {

/// Reads the Velodyne data packets (UDP over IPv4) of a capture one by one, in bounded memory: those to port 2368 or,
/// where nothing comes there, to the one port that gets such packets; of several LiDARs those of the first. Position
/// packets and other traffic are left out. pcap and pcapng; Ethernet with or without VLAN tags, Linux cooked and raw IP
/// frames. Stamps: a capture of PcapWriter gives back its own, to the nanosecond; any other starts at 0 and counts the
/// packets' own microseconds, across full hours.
class PcapReader {
 public:
  /// Throws InputError when the file is missing, no capture or of another link type.
  explicit PcapReader(const std::string& path);
  ~PcapReader();
  PcapReader(const PcapReader&) = delete;
  PcapReader& operator=(const PcapReader&) = delete;

  /// The next data packet; false at the end. A copy of one just before is left out, and one that comes up to three
  /// packets late is put in its order. A capture that is cut off after its first data packet ends there. Throws
  /// InputError, with the packet's number in the file, where the capture is damaged otherwise, a data packet is short
  /// or its flags or product are not those of a known Velodyne LiDAR, its time goes back or leaps by more than
  /// `max_gap`, or the end comes without any data packet.
  [[nodiscard]] bool next(Vlp16Packet& packet);
  /// Time of the first packet on the clock of the computer that captured it; 0 for a capture of PcapWriter.
  [[nodiscard]] Nanoseconds origin() const;

  /// Of copies, late packets, other LiDARs and a cut so far, a sentence each.
  [[nodiscard]] std::vector<std::string> left_out() const;
  /// Of a port that is not the usual one.
  [[nodiscard]] std::vector<std::string> assumed() const;
  /// Whether the capture ended within a packet.
  [[nodiscard]] bool is_cut_off() const;

  /// A robot may be kidnapped for a minute; the sensor's own clock resolves gaps of up to half an hour.
  static constexpr Nanoseconds max_gap = 120'000'000'000;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Writes packets as the sensor sends them (1,248 bytes each), a position packet (554 bytes) before every fifth, with
/// nanosecond stamps. The file appears complete on finish() or not at all. Throws EnvironmentError when it cannot be
/// written.
class PcapWriter {
 public:
  explicit PcapWriter(const std::string& path);
  ~PcapWriter();
  PcapWriter(const PcapWriter&) = delete;
  PcapWriter& operator=(const PcapWriter&) = delete;

  void add(const Vlp16Packet& packet);
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumbline::slam
