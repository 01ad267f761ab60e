// SPDX-License-Identifier: Apache-2.0
#include "slam/io/packets/position_packet.h"

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "slam/io/second.h"

namespace plumbline::slam {

namespace {

constexpr std::size_t time_at = 198;
constexpr std::size_t pps_at = 202;
constexpr std::size_t sentence_at = 206;
constexpr std::uint8_t pps_locked = 2;

}  // namespace

std::string gprmc_sentence(Nanoseconds stamp) {
  using namespace std::chrono;
  const sys_seconds time = sys_days{year{2020} / January / 1} + std::chrono::seconds{stamp / second_ns};
  const sys_days day = floor<days>(time);
  const year_month_day date{day};
  const hh_mm_ss clock{time - day};
  std::array<char, 80> text{};
  std::snprintf(text.data(), text.size(),
                "GPRMC,%02d%02d%02d,A,0000.0000,N,00000.0000,E,000.0,000.0,%02u%02u%02d,000.0,E",
                static_cast<int>(clock.hours().count()), static_cast<int>(clock.minutes().count()),
                static_cast<int>(clock.seconds().count()), static_cast<unsigned>(date.day()),
                static_cast<unsigned>(date.month()), static_cast<int>(date.year()) % 100);
  const std::string body(text.data());
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  std::array<char, 4> check{};
  std::snprintf(check.data(), check.size(), "*%02X", sum & 0xffU);
  return "$" + body + check.data();
}

std::array<std::uint8_t, position_payload_bytes> position_payload(Nanoseconds stamp) {
  std::array<std::uint8_t, position_payload_bytes> bytes{};
  const auto us = static_cast<std::uint32_t>(stamp / 1000 % hour_us);
  for (std::size_t i = 0; i < 4; ++i) bytes[time_at + i] = static_cast<std::uint8_t>(us >> (8 * i));
  bytes[pps_at] = pps_locked;
  const std::string sentence = gprmc_sentence(stamp) + "\r\n";
  std::copy(sentence.begin(), sentence.end(), bytes.begin() + sentence_at);
  return bytes;
}

}  // namespace plumbline::slam
