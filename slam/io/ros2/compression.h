// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace plumbline::slam {

/// Largest piece of a bag that is unpacked at once.
inline constexpr std::uint64_t most_unpacked_bytes = std::uint64_t{1} << 30U;

/// Unpacks "" (nothing to do), "zstd" or "lz4" (its frame format), into `size` bytes, which must be what comes out.
/// Throws InputError without a mark, before it allocates, where the size is more than the bytes can hold.
[[nodiscard]] std::vector<std::uint8_t> unpack(std::string_view compression, std::span<const std::uint8_t> bytes,
                                               std::uint64_t size);
/// The same of bytes that are cut off, or damaged from some place on: what comes out before, at most `size` bytes.
[[nodiscard]] std::vector<std::uint8_t> unpack_beginning(std::string_view compression,
                                                         std::span<const std::uint8_t> bytes, std::uint64_t size);
/// One lz4 frame, of whatever options, that fills `out` exactly. Throws InputError without a mark.
void unpack_lz4(std::span<const std::uint8_t> bytes, std::span<std::uint8_t> out);
/// A zstd frame that says its own size.
[[nodiscard]] std::vector<std::uint8_t> unpack_zstd(std::span<const std::uint8_t> bytes);
/// The other way, with "", "zstd" or "lz4".
[[nodiscard]] std::vector<std::uint8_t> pack(std::string_view compression, std::vector<std::uint8_t> bytes);

}  // namespace plumbline::slam
