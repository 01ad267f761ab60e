// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace plumbline::scenarios {

/// Raw deflate (RFC 1951), level 6: what a browser's DecompressionStream("deflate-raw") reads. The same bytes give the
/// same bytes with one version of zlib.
[[nodiscard]] std::string deflated(std::string_view bytes);
/// What deflated() packed. Throws InternalError unless it has `size` bytes.
[[nodiscard]] std::string inflated(std::string_view packed, std::size_t size);
/// Base64 (RFC 4648) in one line.
[[nodiscard]] std::string base64(std::string_view bytes);

}  // namespace plumbline::scenarios
