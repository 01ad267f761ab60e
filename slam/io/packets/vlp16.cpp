// SPDX-License-Identifier: Apache-2.0
#include "slam/io/packets/vlp16.h"

#include <cmath>
#include <numbers>
#include <string>

#include "bim/errors.h"
#include "slam/io/second.h"

namespace plumbline::slam {

namespace {

constexpr std::size_t blocks = 12;
constexpr std::size_t block_bytes = 100;
constexpr std::size_t block_words = 32;
constexpr std::size_t word_bytes = 3;
constexpr std::size_t time_at = 1200;
constexpr std::size_t return_mode_at = 1204;
constexpr std::size_t product_at = 1205;
constexpr std::array<std::uint8_t, 3> mode_bytes = {0x37, 0x38, 0x39};  // in the order of ReturnMode
constexpr int full_turn_cdeg = 36000;
constexpr double cdeg = std::numbers::pi / 18000.0;

using Payload = std::array<std::uint8_t, vlp16::payload_bytes>;

void put16(Payload& bytes, std::size_t i, unsigned value) {
  bytes[i] = static_cast<std::uint8_t>(value & 0xffU);
  bytes[i + 1] = static_cast<std::uint8_t>(value >> 8U);
}

int get16(const Payload& bytes, std::size_t i) { return bytes[i] | (bytes[i + 1] << 8); }

/// Azimuth of a block, 0.01 degrees.
int block_azimuth(const Payload& bytes, std::size_t block) { return get16(bytes, block * block_bytes + 2); }

void put_words(Payload& bytes, std::size_t block, unsigned azimuth_cdeg, std::span<const ReturnWord> words) {
  const std::size_t start = block * block_bytes;
  put16(bytes, start, 0xeeffU);
  put16(bytes, start + 2, azimuth_cdeg);
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i].distance > 0xffffU) throw InternalError("distance of a return beyond 16 bits");
    const std::size_t at = start + 4 + word_bytes * i;
    put16(bytes, at, words[i].distance);
    bytes[at + 2] = words[i].reflectivity;
  }
}

ReturnWord get_word(const Payload& bytes, std::size_t block, std::size_t i) {
  const std::size_t at = block * block_bytes + 4 + word_bytes * i;
  return {static_cast<std::uint32_t>(get16(bytes, at)), bytes[at + 2]};
}

/// Empty scan of so many columns that begins with the firing at `first`.
Scan empty_scan(const LidarModel& model, Nanoseconds last_firing, std::size_t columns) {
  Scan scan;
  scan.stamp = last_firing + last_laser_ns(model);
  scan.rings = model.rings();
  scan.columns = static_cast<int>(columns);
  const std::size_t size = columns * model.lasers.size();
  scan.range_m.assign(size, 0.0);
  scan.point_L.assign(size, Eigen::Vector3d::Zero());
  scan.reflectivity.assign(size, 0.0F);
  scan.offset_ns.assign(size, 0);
  return scan;
}

/// Azimuth of a shot as cosine and sine.
struct Turn {
  double c = 1.0;
  double s = 0.0;

  static Turn by(double angle) { return {std::cos(angle), std::sin(angle)}; }
  [[nodiscard]] Turn then(const Turn& o) const { return {c * o.c - s * o.s, s * o.c + c * o.s}; }
};

/// Fills one slot of a scan: its time, and its point where something returned.
void put_return(const Laser& laser, double unit_m, const ReturnWord& word, const Turn& azimuth, bool vertical_offsets,
                std::size_t slot, Scan& scan) {
  if (word.distance == 0) return;
  const double range = word.distance * unit_m;
  const double flat = range * laser.cosine;
  scan.range_m[slot] = range;
  scan.point_L[slot] = {flat * azimuth.c, -flat * azimuth.s,
                        range * laser.sine + (vertical_offsets ? laser.height_m : 0.0)};
  scan.reflectivity[slot] = word.reflectivity;
}

/// Decodes the packets of one message into a scan.
class Decoder {
 public:
  Decoder(PacketKind kind, bool vertical_offsets, ReturnMode of_dual, Scan& scan)
      : model_(*kind.model),
        dual_(kind.mode == ReturnMode::dual),
        compare_(dual_ && of_dual != ReturnMode::last),
        vertical_offsets_(vertical_offsets),
        firings_in_block_(block_words / model_.lasers.size()),
        scan_(scan) {}

  /// Into the columns from `column` on.
  void decode(const Vlp16Packet& packet, std::size_t column) {
    const std::size_t step = dual_ ? 2 : 1;
    for (std::size_t b = 0; b < blocks; b += step) {
      const std::size_t from = b + step < blocks ? b : b - step;
      const int turned = block_azimuth(packet.payload, from + step) - block_azimuth(packet.payload, from);
      choose_turns((turned + full_turn_cdeg) % full_turn_cdeg);
      decode_block(packet, b, column);
      column += firings_in_block_;
    }
  }

 private:
  /// Turns of the shots of one block from its azimuth on, when the head turns so far in it.
  void choose_turns(int turned_cdeg) {
    if (turned_cdeg == turned_cdeg_) return;
    turned_cdeg_ = turned_cdeg;
    const double block_ns = static_cast<double>(model_.firing_period_ns) * static_cast<double>(firings_in_block_);
    for (std::size_t i = 0; i < block_words; ++i) {
      const Laser& laser = model_.lasers[i % model_.lasers.size()];
      const double share = static_cast<double>(time_in_block(i)) / block_ns;
      turns_[i] = Turn::by((turned_cdeg * share + 100.0 * laser.azimuth_deg) * cdeg);
    }
  }

  [[nodiscard]] Nanoseconds time_in_block(std::size_t word) const {
    const std::size_t lasers = model_.lasers.size();
    return static_cast<Nanoseconds>(word / lasers) * model_.firing_period_ns + model_.lasers[word % lasers].time_ns;
  }

  void decode_block(const Vlp16Packet& packet, std::size_t block, std::size_t column) {
    const std::size_t lasers = model_.lasers.size();
    const Turn azimuth = Turn::by(block_azimuth(packet.payload, block) * cdeg);
    const auto firing = static_cast<Nanoseconds>(block / (dual_ ? 2 : 1) * firings_in_block_);
    const Nanoseconds since_stamp = packet.stamp + firing * model_.firing_period_ns - scan_.stamp;
    for (std::size_t i = 0; i < block_words; ++i) {
      const Laser& laser = model_.lasers[i % lasers];
      const std::size_t slot = (column + i / lasers) * lasers + static_cast<std::size_t>(laser.ring);
      scan_.offset_ns[slot] = static_cast<std::int32_t>(since_stamp + time_in_block(i));
      ReturnWord word = get_word(packet.payload, block, i);
      if (compare_)
        if (const ReturnWord other = get_word(packet.payload, block + 1, i); seems_stronger(other, word)) word = other;
      put_return(laser, model_.range_unit_m, word, azimuth.then(turns_[i]), vertical_offsets_, slot, scan_);
    }
  }

  const LidarModel& model_;
  bool dual_;
  bool compare_;  ///< the two blocks of a pair; else the first is taken, which holds the last returns
  bool vertical_offsets_;
  std::size_t firings_in_block_;
  Scan& scan_;
  int turned_cdeg_ = -1;
  std::array<Turn, block_words> turns_{};
};

const Laser& vlp16_laser(int laser) { return lidar_model(LidarModelId::vlp16).lasers[static_cast<std::size_t>(laser)]; }

}  // namespace

namespace vlp16 {

double elevation_deg(int laser) { return vlp16_laser(laser).elevation_deg; }
double cos_elevation(int laser) { return vlp16_laser(laser).cosine; }
double sin_elevation(int laser) { return vlp16_laser(laser).sine; }
double vertical_offset_m(int laser) { return vlp16_laser(laser).height_m; }
int ring_of_laser(int laser) { return vlp16_laser(laser).ring; }

Eigen::Vector3d direction_L(int laser, double azimuth) {
  const double c = cos_elevation(laser);
  return {c * std::cos(azimuth), -c * std::sin(azimuth), sin_elevation(laser)};
}

}  // namespace vlp16

std::int64_t time_in_payload_us(const Vlp16Packet& packet) {
  return get16(packet.payload, time_at) + (std::int64_t{get16(packet.payload, time_at + 2)} << 16);
}

void set_time(Vlp16Packet& packet, Nanoseconds stamp) {
  packet.stamp = stamp;
  const auto time_us = static_cast<std::uint32_t>(stamp / 1000 % hour_us);
  put16(packet.payload, time_at, time_us & 0xffffU);
  put16(packet.payload, time_at + 2, time_us >> 16U);
}

int firings_in_packet(const LidarModel& model, ReturnMode mode) {
  return mode == ReturnMode::dual ? model.firings_per_packet / 2 : model.firings_per_packet;
}

void encode_packet(const LidarModel& model, ReturnMode mode, Nanoseconds stamp,
                   std::span<const std::uint16_t> azimuth_cdeg, std::span<const ReturnWord> words,
                   std::span<const ReturnWord> last, Vlp16Packet& packet) {
  const std::size_t lasers = model.lasers.size();
  const auto firings = static_cast<std::size_t>(firings_in_packet(model, mode));
  const bool dual = mode == ReturnMode::dual;
  if (model.product == 0) throw InternalError(std::string(model.name) + " sends no Velodyne packets");
  if (azimuth_cdeg.size() != firings || words.size() != firings * lasers || (dual && last.size() != words.size()))
    throw InternalError("encode_packet: the firings of one packet are needed");
  const std::size_t step = block_words / lasers;
  for (std::size_t f = 0, block = 0; f < firings; f += step) {
    if (azimuth_cdeg[f] >= full_turn_cdeg) throw InternalError("azimuth of a firing beyond 360 degrees");
    if (dual) put_words(packet.payload, block++, azimuth_cdeg[f], last.subspan(f * lasers, block_words));
    put_words(packet.payload, block++, azimuth_cdeg[f], words.subspan(f * lasers, block_words));
  }
  set_time(packet, stamp);
  packet.payload[return_mode_at] = mode_bytes[static_cast<std::size_t>(mode)];
  packet.payload[product_at] = model.product;
}

Vlp16Packet encode_packet(Nanoseconds stamp, std::span<const Vlp16Firing, 24> firings) {
  std::array<std::uint16_t, 24> azimuth_cdeg;
  std::array<ReturnWord, 24 * 16> words;
  for (std::size_t f = 0; f < firings.size(); ++f) {
    azimuth_cdeg[f] = firings[f].azimuth_cdeg;
    for (std::size_t k = 0; k < 16; ++k) words[16 * f + k] = {firings[f].distance[k], firings[f].reflectivity[k]};
  }
  Vlp16Packet packet;
  encode_packet(lidar_model(LidarModelId::vlp16), ReturnMode::strongest, stamp, azimuth_cdeg, words, {}, packet);
  return packet;
}

bool seems_stronger(const ReturnWord& a, const ReturnWord& b) {
  if (a.distance == 0 || b.distance == 0) return b.distance == 0;
  const auto squared = [](std::uint32_t distance) { return std::uint64_t{distance} * distance; };
  return a.reflectivity * squared(b.distance) >= b.reflectivity * squared(a.distance);
}

PacketKind packet_kind(const Vlp16Packet& packet) {
  const Payload& bytes = packet.payload;
  PacketKind kind{velodyne_model(bytes[product_at])};
  if (kind.model == nullptr)
    throw InputError({}, "LiDAR packet of product " + std::to_string(bytes[product_at]) +
                             "; 34 (VLP-16), 40 (VLP-32C) or 33 (HDL-32E) would be right");
  std::size_t mode = 0;
  while (mode < mode_bytes.size() && mode_bytes[mode] != bytes[return_mode_at]) ++mode;
  if (mode == mode_bytes.size())
    throw InputError({}, "LiDAR packet in return mode " + std::to_string(bytes[return_mode_at]) +
                             "; 55 (strongest), 56 (last) or 57 (dual) would be right");
  kind.mode = static_cast<ReturnMode>(mode);
  for (std::size_t b = 0; b < blocks; ++b) {
    if (bytes[b * block_bytes] != 0xff || bytes[b * block_bytes + 1] != 0xee)
      throw InputError({}, "LiDAR packet without the flag ff ee at the start of block " + std::to_string(b));
    if (block_azimuth(bytes, b) >= full_turn_cdeg)
      throw InputError({}, "LiDAR packet with azimuth " + std::to_string(block_azimuth(bytes, b)) + " in block " +
                               std::to_string(b) + "; below 36000 would be right");
  }
  return kind;
}

Scan decode_message(std::span<const Vlp16Packet> packets, bool vertical_offsets, ReturnMode of_dual) {
  if (packets.empty()) throw InputError({}, "LiDAR message without packets; at least one is needed");
  const PacketKind kind = packet_kind(packets.front());
  for (const Vlp16Packet& packet : packets) {
    const PacketKind other = packet_kind(packet);
    if (other.model != kind.model || other.mode != kind.mode)
      throw InputError({},
                       "LiDAR message of packets from different sensors or return modes; one of each would be right");
  }
  const int firings = firings_in_packet(*kind.model, kind.mode);
  const auto columns = static_cast<std::size_t>(firings);
  Scan scan = empty_scan(*kind.model, packets.back().stamp + (firings - 1) * kind.model->firing_period_ns,
                         packets.size() * columns);
  Decoder decoder(kind, vertical_offsets, of_dual, scan);
  for (std::size_t i = 0; i < packets.size(); ++i) decoder.decode(packets[i], i * columns);
  return scan;
}

Scan scan_of_words(const LidarModel& model, Nanoseconds first_firing, std::span<const double> azimuth,
                   std::span<const ReturnWord> words, bool vertical_offsets) {
  const std::size_t lasers = model.lasers.size();
  if (azimuth.empty() || words.size() != azimuth.size() * lasers)
    throw InternalError("scan_of_words: an azimuth a firing and a word a laser are needed");
  const auto columns = static_cast<Nanoseconds>(azimuth.size());
  Scan scan = empty_scan(model, first_firing + (columns - 1) * model.firing_period_ns, azimuth.size());
  for (std::size_t column = 0; column < azimuth.size(); ++column)
    for (std::size_t k = 0; k < lasers; ++k) {
      const Laser& laser = model.lasers[k];
      const std::size_t slot = column * lasers + static_cast<std::size_t>(laser.ring);
      const Nanoseconds time = first_firing + static_cast<Nanoseconds>(column) * model.firing_period_ns + laser.time_ns;
      scan.offset_ns[slot] = static_cast<std::int32_t>(time - scan.stamp);
      const Turn turn = Turn::by(azimuth[column] + 100.0 * laser.azimuth_deg * cdeg);
      put_return(laser, model.range_unit_m, words[column * lasers + k], turn, vertical_offsets, slot, scan);
    }
  return scan;
}

}  // namespace plumbline::slam
