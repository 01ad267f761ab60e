// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace plumbline::bim {

/// The 128 bits of a GlobalId.
struct IdBits {
  std::uint64_t high = 0;
  std::uint64_t low = 0;
  friend bool operator==(const IdBits&, const IdBits&) = default;
};

/// 22 characters of the IFC alphabet, 6 bits each, the highest first; the first holds 2 bits and is 0 to 3
/// [iso2018, IfcGloballyUniqueId].
[[nodiscard]] std::string global_id(const IdBits& bits);

/// The bits of a GlobalId, or nullopt when the text is none.
[[nodiscard]] std::optional<IdBits> global_id_bits(std::string_view text);

}  // namespace plumbline::bim
