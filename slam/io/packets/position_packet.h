// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "slam/io/records.h"

namespace plumbline::slam {

inline constexpr std::size_t position_payload_bytes = 512;

/// $GPRMC sentence of a receiver at 0 N 0 E, without the line's end: time 0 of a recording is 1 January 2020, 00:00
/// UTC, so that it depends on the recording alone.
[[nodiscard]] std::string gprmc_sentence(Nanoseconds stamp);

/// Payload of the packet a VLP-16 sends to UDP port 8308 [velodyne2018, pages 60-61]: microseconds of the hour, PPS
/// locked, and the sentence.
[[nodiscard]] std::array<std::uint8_t, position_payload_bytes> position_payload(Nanoseconds stamp);

}  // namespace plumbline::slam
