// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

/// Numbers of the MCAP format [mcap2024].
namespace plumbline::slam::mcap {

inline constexpr std::array<std::uint8_t, 8> magic = {0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
inline constexpr std::uint64_t head_bytes = 9;     ///< of a record: opcode and length
inline constexpr std::uint64_t footer_bytes = 20;  ///< without its head

enum class Op : std::uint8_t {
  none = 0x00,
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  statistics = 0x0B,
  summary_offset = 0x0E,
  data_end = 0x0F,
};

}  // namespace plumbline::slam::mcap
