// SPDX-License-Identifier: Apache-2.0
#include "slam/io/vlp16.h"

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>

#include "bim/errors.h"

namespace plumbline::slam {

namespace {

constexpr std::size_t blocks = 12;
constexpr std::size_t block_bytes = 100;
constexpr std::size_t firing_bytes = 48;
constexpr std::size_t time_at = 1200;
constexpr std::size_t return_mode_at = 1204;
constexpr std::size_t product_at = 1205;
constexpr std::uint8_t strongest_return = 0x37;
constexpr std::uint8_t last_return = 0x38;
constexpr std::uint8_t product_vlp16 = 0x22;
constexpr int full_turn_cdeg = 36000;
constexpr std::int64_t hour_us = 3'600'000'000;

constexpr std::array<int, 16> elevations_deg = {-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15};
constexpr std::array<double, 16> offsets_mm = {11.2, -0.7, 9.7, -2.2, 8.1, -3.7, 6.6, -5.1,
                                               5.1,  -6.6, 3.7, -8.1, 2.2, -9.7, 0.7, -11.2};
// Of 1, 3, ... 15 degrees. Written out, since compilers and libraries round them differently.
constexpr std::array<double, 8> cosines = {0.9998476951563913, 0.9986295347545738, 0.9961946980917455,
                                           0.992546151641322,  0.9876883405951378, 0.981627183447664,
                                           0.9743700647852352, 0.9659258262890683};
constexpr std::array<double, 8> sines = {0.01745240643728351, 0.052335956242943835, 0.08715574274765817,
                                         0.12186934340514748, 0.15643446504023087,  0.1908089953765448,
                                         0.224951054343865,   0.25881904510252074};

using Payload = std::array<std::uint8_t, vlp16::payload_bytes>;

std::size_t at(int laser) { return static_cast<std::size_t>(laser); }

void put16(Payload& bytes, std::size_t i, unsigned value) {
  bytes[i] = static_cast<std::uint8_t>(value & 0xffU);
  bytes[i + 1] = static_cast<std::uint8_t>(value >> 8U);
}

int get16(const Payload& bytes, std::size_t i) { return bytes[i] | (bytes[i + 1] << 8); }

/// Azimuth of a block, 0.01 degrees.
int block_azimuth(const Payload& bytes, std::size_t block) { return get16(bytes, block * block_bytes + 2); }

/// Clockwise turn from one block to the next, 0.01 degrees; the last block repeats the turn before it.
int block_turn(const Payload& bytes, std::size_t block) {
  const std::size_t from = block + 1 < blocks ? block : block - 1;
  return (block_azimuth(bytes, from + 1) - block_azimuth(bytes, from) + full_turn_cdeg) % full_turn_cdeg;
}

void check(const Payload& bytes) {
  if (bytes[product_at] != product_vlp16)
    throw InputError({}, "LiDAR packet of product " + std::to_string(bytes[product_at]) + "; a VLP-16 says 34 (0x22)");
  const std::uint8_t mode = bytes[return_mode_at];
  if (mode != strongest_return && mode != last_return)
    throw InputError({}, "LiDAR packet in return mode " + std::to_string(mode) +
                             "; this version reads 55 (strongest) and 56 (last)");
  for (std::size_t b = 0; b < blocks; ++b) {
    if (bytes[b * block_bytes] != 0xff || bytes[b * block_bytes + 1] != 0xee)
      throw InputError({}, "LiDAR packet without the flag ff ee at the start of block " + std::to_string(b));
    if (block_azimuth(bytes, b) >= full_turn_cdeg)
      throw InputError({}, "LiDAR packet with azimuth " + std::to_string(block_azimuth(bytes, b)) + " in block " +
                               std::to_string(b) + "; below 36000 would be right");
  }
}

/// Decodes one packet into 24 columns of the scan, the first being `column`.
void decode_packet(const Vlp16Packet& packet, int column, bool vertical_offsets, Scan& scan) {
  for (int f = 0; f < vlp16::firings_per_packet; ++f) {
    const auto block = static_cast<std::size_t>(f / 2);
    const double azimuth_cdeg = block_azimuth(packet.payload, block);
    const double turn_cdeg = block_turn(packet.payload, block);
    for (int k = 0; k < vlp16::rings; ++k) {
      const std::int64_t in_block_ns = (f % 2) * vlp16::firing_period_ns + k * vlp16::laser_period_ns;
      const Nanoseconds time = packet.stamp + (f / 2) * 2 * vlp16::firing_period_ns + in_block_ns;
      const std::size_t slot = at((column + f) * vlp16::rings + vlp16::ring_of_laser(k));
      scan.offset_ns[slot] = static_cast<std::int32_t>(time - scan.stamp);
      const std::size_t byte = block * block_bytes + 4 + at(f % 2) * firing_bytes + 3 * at(k);
      const int distance = get16(packet.payload, byte);
      if (distance == 0) continue;
      const double share = static_cast<double>(in_block_ns) / static_cast<double>(2 * vlp16::firing_period_ns);
      const double azimuth = (azimuth_cdeg + turn_cdeg * share) * (std::numbers::pi / 18000.0);
      scan.range_m[slot] = distance * vlp16::range_unit_m;
      scan.point_L[slot] = scan.range_m[slot] * vlp16::direction_L(k, azimuth);
      if (vertical_offsets) scan.point_L[slot].z() += vlp16::vertical_offset_m(k);
      scan.reflectivity[slot] = packet.payload[byte + 2];
    }
  }
}

}  // namespace

namespace vlp16 {

double elevation_deg(int laser) { return elevations_deg.at(at(laser)); }
double cos_elevation(int laser) { return cosines[at(std::abs(elevations_deg.at(at(laser))) / 2)]; }
double sin_elevation(int laser) {
  const int degrees = elevations_deg.at(at(laser));
  const double sine = sines[at(std::abs(degrees) / 2)];
  return degrees < 0 ? -sine : sine;
}
double vertical_offset_m(int laser) { return offsets_mm.at(at(laser)) * 1e-3; }
int ring_of_laser(int laser) { return laser % 2 == 0 ? laser / 2 : 8 + laser / 2; }

Eigen::Vector3d direction_L(int laser, double azimuth) {
  const double c = cos_elevation(laser);
  return {c * std::cos(azimuth), -c * std::sin(azimuth), sin_elevation(laser)};
}

}  // namespace vlp16

Vlp16Packet encode_packet(Nanoseconds stamp, std::span<const Vlp16Firing, 24> firings) {
  Vlp16Packet packet;
  packet.stamp = stamp;
  Payload& bytes = packet.payload;
  for (std::size_t f = 0; f < firings.size(); ++f) {
    const std::size_t start = f / 2 * block_bytes;
    if (f % 2 == 0) {
      if (firings[f].azimuth_cdeg >= full_turn_cdeg) throw InternalError("azimuth of a firing beyond 360 degrees");
      put16(bytes, start, 0xeeffU);
      put16(bytes, start + 2, firings[f].azimuth_cdeg);
    }
    for (std::size_t k = 0; k < firings[f].distance.size(); ++k) {
      const std::size_t byte = start + 4 + f % 2 * firing_bytes + 3 * k;
      put16(bytes, byte, firings[f].distance[k]);
      bytes[byte + 2] = firings[f].reflectivity[k];
    }
  }
  const auto time_us = static_cast<std::uint32_t>(stamp / 1000 % hour_us);
  put16(bytes, time_at, time_us & 0xffffU);
  put16(bytes, time_at + 2, time_us >> 16U);
  bytes[return_mode_at] = strongest_return;
  bytes[product_at] = product_vlp16;
  return packet;
}

Scan decode_message(std::span<const Vlp16Packet> packets, bool vertical_offsets) {
  if (packets.empty()) throw InputError({}, "LiDAR message without packets; at least one is needed");
  for (const Vlp16Packet& packet : packets) check(packet.payload);
  Scan scan;
  scan.stamp = packets.back().stamp + (vlp16::firings_per_packet - 1) * vlp16::firing_period_ns +
               (vlp16::rings - 1) * vlp16::laser_period_ns;
  scan.rings = vlp16::rings;
  scan.columns = static_cast<int>(packets.size()) * vlp16::firings_per_packet;
  const auto size = static_cast<std::size_t>(scan.columns) * vlp16::rings;
  scan.range_m.assign(size, 0.0);
  scan.point_L.assign(size, Eigen::Vector3d::Zero());
  scan.reflectivity.assign(size, 0.0F);
  scan.offset_ns.assign(size, 0);
  for (std::size_t i = 0; i < packets.size(); ++i)
    decode_packet(packets[i], static_cast<int>(i) * vlp16::firings_per_packet, vertical_offsets, scan);
  return scan;
}

}  // namespace plumbline::slam
