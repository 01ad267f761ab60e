// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "slam/io/records.h"

namespace plumbline::slam {

/// Constants of the Velodyne VLP-16 (user manual 63-9243, pages 49-62).
namespace vlp16 {
inline constexpr int rings = 16;
inline constexpr int firings_per_packet = 24;
inline constexpr int packets_per_message = 76;  ///< as the ROS driver cuts them at 10 Hz: 1,824 columns
inline constexpr int payload_bytes = 1206;
inline constexpr std::int64_t laser_period_ns = 2304;
inline constexpr std::int64_t firing_period_ns = 55296;
inline constexpr double range_unit_m = 0.002;
/// Elevation of laser id k (firing order), degrees.
[[nodiscard]] double elevation_deg(int laser);
[[nodiscard]] double cos_elevation(int laser);
[[nodiscard]] double sin_elevation(int laser);
/// Height of laser id k's origin above the sensor's origin, m.
[[nodiscard]] double vertical_offset_m(int laser);
/// Rank by elevation (0 lowest) of laser id k.
[[nodiscard]] int ring_of_laser(int laser);
/// Unit direction in L of laser id k at an azimuth (rad, clockwise seen from above, 0 along x).
[[nodiscard]] Eigen::Vector3d direction_L(int laser, double azimuth);
}  // namespace vlp16

/// One data packet: 12 blocks of 2 firings, one return (strongest).
struct Vlp16Packet {
  Nanoseconds stamp = 0;  ///< time of its first firing
  std::array<std::uint8_t, vlp16::payload_bytes> payload{};
};

/// One firing before it is packed.
struct Vlp16Firing {
  std::uint16_t azimuth_cdeg = 0;               ///< of laser 0, 0.01 degrees, clockwise seen from above
  std::array<std::uint16_t, 16> distance{};     ///< by laser id, units of 2 mm; 0: no return
  std::array<std::uint8_t, 16> reflectivity{};  ///< by laser id
};

/// Packs 24 firings. The packet holds the azimuth of every second firing only; stamp's microseconds of the hour stand
/// in its payload. Throws InternalError on an azimuth of 360 degrees or more.
[[nodiscard]] Vlp16Packet encode_packet(Nanoseconds stamp, std::span<const Vlp16Firing, 24> firings);

/// Packets of one message to a scan. Azimuths between blocks are interpolated as the manual says (pages 55-59), over
/// the last block with the step before it. Scan::stamp is the time of the last return slot (laser 15 of the last
/// firing); points lie in L at the return's own time. vertical_offsets false gives the calibration of drivers before
/// 2023 (all 0). Throws InputError on no packets or on a packet with wrong flags, product id or return mode (dual
/// return is not in this version).
[[nodiscard]] Scan decode_message(std::span<const Vlp16Packet> packets, bool vertical_offsets = true);

}  // namespace plumbline::slam
