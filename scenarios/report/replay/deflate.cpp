// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/replay/deflate.h"

#include <zlib.h>

#include <algorithm>
#include <limits>

#include "bim/errors.h"

namespace plumbline::scenarios {

namespace {

constexpr int raw_window = -15;  // 32 kB, no header

uInt small(std::size_t size) {
  if (size > std::numeric_limits<uInt>::max()) throw InternalError("a block of the replay page is beyond 4 GB");
  return static_cast<uInt>(size);
}

/// zlib does not write what it reads, but older versions take no pointer to const.
Bytef* bytes_of(std::string_view text) { return reinterpret_cast<Bytef*>(const_cast<char*>(text.data())); }

}  // namespace

std::string deflated(std::string_view bytes) {
  z_stream stream{};
  if (deflateInit2(&stream, 6, Z_DEFLATED, raw_window, 8, Z_DEFAULT_STRATEGY) != Z_OK)
    throw EnvironmentError("zlib: no memory");
  std::string packed(deflateBound(&stream, static_cast<uLong>(bytes.size())), '\0');
  stream.next_in = bytes_of(bytes);
  stream.avail_in = small(bytes.size());
  stream.next_out = bytes_of(packed);
  stream.avail_out = small(packed.size());
  const int code = deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  if (code != Z_STREAM_END) throw InternalError("zlib: deflate did not end");
  return packed;
}

std::string inflated(std::string_view packed, std::size_t size) {
  z_stream stream{};
  if (inflateInit2(&stream, raw_window) != Z_OK) throw EnvironmentError("zlib: no memory");
  std::string bytes(size, '\0');
  stream.next_in = bytes_of(packed);
  stream.avail_in = small(packed.size());
  stream.next_out = bytes_of(bytes);
  stream.avail_out = small(size);
  const int code = inflate(&stream, Z_FINISH);
  const bool whole = code == Z_STREAM_END && stream.total_out == size;
  inflateEnd(&stream);
  if (!whole) throw InternalError("zlib: a packed block is damaged");
  return bytes;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t here = std::min<std::size_t>(3, bytes.size() - i);
    unsigned value = 0;
    for (std::size_t k = 0; k < 3; ++k)
      value = value << 8U | (k < here ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) out += k <= here ? digits[value >> (18 - 6 * k) & 63U] : '=';
  }
  return out;
}

}  // namespace plumbline::scenarios
