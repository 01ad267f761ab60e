// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>

namespace plumbline::slam {

/// The room of foreign_capture(): half sizes in m around the sensor, which stands in its middle.
inline constexpr double hall_x_m = 4.0, hall_y_m = 3.0, hall_z_m = 0.7;

/// Bytes of a capture as another program on another machine writes one: big endian, stamps in microseconds, position
/// packets and other traffic in between. A VLP-16 at 10 Hz (strongest return) stands in the middle of the hall. Every
/// third beam has no return: those with (firing + laser) % 3 == 0. It begins on 1 January 2000, 2.5 ms before the full
/// hour. Nothing of this uses the program's own encoder.
inline std::string foreign_capture(int packets) {
  constexpr std::int64_t arrival_us = 946'684'800'000'000, first_us = 3'599'997'500, hour_us = 3'600'000'000;
  constexpr double firing_us = 55.296, laser_us = 2.304, degrees_per_us = 3600e-6, degree = std::numbers::pi / 180.0;
  // By laser: elevation, and the height of its origin above the sensor's.
  constexpr std::array<double, 16> elevation_deg{-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15};
  constexpr std::array<double, 16> height_mm{11.2, -0.7, 9.7, -2.2, 8.1, -3.7, 6.6, -5.1,
                                             5.1,  -6.6, 3.7, -8.1, 2.2, -9.7, 0.7, -11.2};
  const auto big = [](std::uint64_t value, int bytes) {
    std::string text;
    for (int i = bytes - 1; i >= 0; --i) text += static_cast<char>(value >> (8 * i) & 0xff);
    return text;
  };
  const auto little = [&](std::uint64_t value, int bytes) {
    const std::string text = big(value, bytes);
    return std::string(text.rbegin(), text.rend());
  };
  const auto frame = [&](std::int64_t us, std::uint16_t port, const std::string& payload) {
    const std::string udp = big(port, 2) + big(port, 2) + big(8 + payload.size(), 2) + big(0, 2) + payload;
    const std::string ip = big(0x4500, 2) + big(20 + udp.size(), 2) + big(0, 4) + big(0x4011, 2) + big(0, 2) +
                           big(0xc0a801c9, 4) + big(0xffffffff, 4) + udp;
    const std::string ethernet = big(0xffffffffffff, 6) + big(0x60768820, 6) + big(0x0800, 2) + ip;
    const auto stamp = static_cast<std::uint64_t>(us);
    return big(stamp / 1'000'000, 4) + big(stamp % 1'000'000, 4) + big(ethernet.size(), 4) + big(ethernet.size(), 4) +
           ethernet;
  };

  std::string capture = big(0xa1b2c3d4, 4) + big(2, 2) + big(4, 2) + big(0, 8) + big(65535, 4) + big(1, 4);
  for (int packet = 0; packet < packets; ++packet) {
    const double start_us = 24 * firing_us * packet;
    const auto turn = [&](int firing) { return std::fmod(degrees_per_us * (start_us + firing_us * firing), 360.0); };
    std::string payload;
    for (int block = 0; block < 12; ++block) {
      payload += little(0xeeff, 2) + little(static_cast<std::uint64_t>(std::lround(100 * turn(2 * block))) % 36000, 2);
      for (int firing = 2 * block; firing < 2 * block + 2; ++firing)
        for (std::size_t laser = 0; laser < 16; ++laser) {
          // Clockwise from the x axis of L.
          const double azimuth = degree * (turn(firing) + degrees_per_us * laser_us * static_cast<double>(laser));
          const double up = degree * elevation_deg[laser], z = 1e-3 * height_mm[laser];
          const double range = std::min({hall_x_m / std::abs(std::cos(up) * std::cos(azimuth)),
                                         hall_y_m / std::abs(std::cos(up) * std::sin(azimuth)),
                                         (up > 0 ? hall_z_m - z : hall_z_m + z) / std::abs(std::sin(up))});
          const bool none = (24 * packet + firing + static_cast<int>(laser)) % 3 == 0;
          payload += little(none ? 0 : static_cast<std::uint64_t>(std::lround(range / 0.002)), 2) + little(40, 1);
        }
    }
    const std::int64_t us = std::llround(start_us);
    payload += little(static_cast<std::uint64_t>((first_us + us) % hour_us), 4) + little(0x2237, 2);
    if (packet % 5 == 0) capture += frame(arrival_us + us, 8308, std::string(512, '\0'));
    if (packet % 7 == 0) capture += frame(arrival_us + us, 53, "a question to somebody else");
    capture += frame(arrival_us + us, 2368, payload);
  }
  return capture;
}

}  // namespace plumbline::slam
