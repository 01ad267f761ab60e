// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "slam/io/lidar_model.h"
#include "slam/io/records.h"

namespace plumbline::slam {

/// Constants of the Velodyne VLP-16 [velodyne2018, pages 49-62].
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

/// One data packet of a VLP-16, VLP-32C or HDL-32E: 12 blocks of 32 returns.
struct Vlp16Packet {
  Nanoseconds stamp = 0;  ///< time of its first firing
  std::array<std::uint8_t, vlp16::payload_bytes> payload{};
};

/// Microseconds of the hour at which a packet began, from its payload.
[[nodiscard]] std::int64_t time_in_payload_us(const Vlp16Packet& packet);
/// Moves a packet to another time, in its payload too.
void set_time(Vlp16Packet& packet, Nanoseconds stamp);

/// One return as it stands in a packet.
struct ReturnWord {
  std::uint32_t distance = 0;  ///< units of the model; 0: no return
  std::uint8_t reflectivity = 0;
};

/// One VLP-16 firing before it is packed.
struct Vlp16Firing {
  std::uint16_t azimuth_cdeg = 0;               ///< of laser 0, 0.01 degrees, clockwise seen from above
  std::array<std::uint16_t, 16> distance{};     ///< by laser id, units of 2 mm; 0: no return
  std::array<std::uint8_t, 16> reflectivity{};  ///< by laser id
};

/// Firings in one packet: half of the model's where every beam has two returns.
[[nodiscard]] int firings_in_packet(const LidarModel& model, ReturnMode mode);

/// Packs the firings of one packet. azimuth_cdeg has one entry a firing (of the head at its start); words stand firing
/// by firing in order of the channels. `last` is read in mode dual only: `words` then holds the strongest returns (or,
/// where that is the last one too, the second strongest). The packet keeps the azimuth of the first firing of each
/// block only; stamp's microseconds of the hour stand in its payload. Throws InternalError on an azimuth of 360 degrees
/// or more, a distance beyond 16 bits, wrong counts, or a model that sends no such packets.
void encode_packet(const LidarModel& model, ReturnMode mode, Nanoseconds stamp,
                   std::span<const std::uint16_t> azimuth_cdeg, std::span<const ReturnWord> words,
                   std::span<const ReturnWord> last, Vlp16Packet& packet);
/// 24 firings of a VLP-16, strongest returns.
[[nodiscard]] Vlp16Packet encode_packet(Nanoseconds stamp, std::span<const Vlp16Firing, 24> firings);

/// Which of two returns of a beam was the stronger, by reflectivity and distance: packets of mode dual do not state it,
/// since the strongest may be the last one. Equal ones: true. A return goes before none.
[[nodiscard]] bool seems_stronger(const ReturnWord& a, const ReturnWord& b);

/// A packet's sensor model and return mode. Throws InputError on wrong flags, an azimuth of 360 degrees or more, or a
/// product or return mode that is not known.
struct PacketKind {
  const LidarModel* model = nullptr;
  ReturnMode mode = ReturnMode::strongest;
};
[[nodiscard]] PacketKind packet_kind(const Vlp16Packet& packet);

/// Packets of one message to a scan. Azimuths between blocks are interpolated as in [velodyne2018, pages 55-59], over
/// the last block with the step before it. Scan::stamp is the time of the last return slot (the last laser of the last
/// firing); points lie in L at the return's own time. vertical_offsets false gives the calibration of drivers before
/// 2023 (all 0). Of two returns a beam the scan holds of_dual: the one that seems_stronger(), or the last. Throws
/// InputError on no packets, packets of different kinds, and as packet_kind() does.
[[nodiscard]] Scan decode_message(std::span<const Vlp16Packet> packets, bool vertical_offsets = true,
                                  ReturnMode of_dual = ReturnMode::strongest);

/// Scan of a model without packets. first_firing is the time of the first firing; azimuth in rad, one a firing; words
/// as in encode_packet().
[[nodiscard]] Scan scan_of_words(const LidarModel& model, Nanoseconds first_firing, std::span<const double> azimuth,
                                 std::span<const ReturnWord> words, bool vertical_offsets = true);

}  // namespace plumbline::slam
