// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

namespace plumbline::bim {

/// Bytes of a number of this type in a .ply file [turk1994]; 0 where there is no such type.
[[nodiscard]] constexpr std::uint32_t ply_type_bytes(std::string_view type) {
  using Types = std::array<std::pair<std::string_view, std::uint32_t>, 16>;
  constexpr Types types = {{{"char", 1},
                            {"int8", 1},
                            {"uchar", 1},
                            {"uint8", 1},
                            {"short", 2},
                            {"int16", 2},
                            {"ushort", 2},
                            {"uint16", 2},
                            {"int", 4},
                            {"int32", 4},
                            {"uint", 4},
                            {"uint32", 4},
                            {"float", 4},
                            {"float32", 4},
                            {"double", 8},
                            {"float64", 8}}};
  for (const auto& [name, bytes] : types)
    if (name == type) return bytes;
  return 0;
}

}  // namespace plumbline::bim
