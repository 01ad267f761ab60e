// SPDX-License-Identifier: Apache-2.0
#include "slam/io/ros2/compression.h"

#include <lz4frame.h>
#include <zstd.h>

#include <memory>
#include <string>

#include "bim/errors.h"

namespace plumbline::slam {

namespace {

using Bytes = std::vector<std::uint8_t>;

/// What stands in a frame besides its blocks.
constexpr std::uint64_t frame_slack = 65536;

void check_size(std::uint64_t size, std::uint64_t packed, std::uint64_t most_ratio) {
  if (size > most_unpacked_bytes)
    throw InputError({}, "a piece of " + std::to_string(size) + " bytes; at most 1 GiB is read");
  if (size > packed * most_ratio + frame_slack)
    throw InputError({}, "a piece of " + std::to_string(size) + " bytes in " + std::to_string(packed) +
                             " compressed ones, which cannot hold so much");
}

Bytes from_zstd(std::span<const std::uint8_t> bytes, std::uint64_t size) {
  constexpr std::uint64_t most_ratio = 32768;  // a block of one byte repeated: 128 KiB in 4 bytes
  check_size(size, bytes.size(), most_ratio);
  Bytes out(size);
  const std::size_t got = ZSTD_decompress(out.data(), out.size(), bytes.data(), bytes.size());
  if (ZSTD_isError(got) != 0) throw InputError({}, std::string("damaged zstd data: ") + ZSTD_getErrorName(got));
  if (got != size) throw InputError({}, "zstd data of another size than stated");
  return out;
}

Bytes from_lz4(std::span<const std::uint8_t> bytes, std::uint64_t size) {
  constexpr std::uint64_t most_ratio = 255;  // of the format
  check_size(size, bytes.size(), most_ratio);
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) != 0)
    throw EnvironmentError("no memory to unpack lz4 data");
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> owner(context,
                                                                                   &LZ4F_freeDecompressionContext);
  Bytes out(size);
  std::size_t at = 0, from = 0, left = 1;
  while (left != 0 && from < bytes.size()) {
    std::size_t room = out.size() - at, taken = bytes.size() - from;
    left = LZ4F_decompress(context, out.data() + at, &room, bytes.data() + from, &taken, nullptr);
    if (LZ4F_isError(left) != 0) throw InputError({}, std::string("damaged lz4 data: ") + LZ4F_getErrorName(left));
    if (room == 0 && taken == 0) break;
    at += room;
    from += taken;
  }
  if (left != 0 || at != size || from != bytes.size()) throw InputError({}, "lz4 data of another size than stated");
  return out;
}

}  // namespace

Bytes unpack(std::string_view compression, std::span<const std::uint8_t> bytes, std::uint64_t size) {
  if (compression == "zstd") return from_zstd(bytes, size);
  if (compression == "lz4") return from_lz4(bytes, size);
  if (!compression.empty())
    throw InputError({}, "a chunk compressed by '" + std::string(compression) + "'; none, zstd and lz4 are read");
  if (size != bytes.size()) throw InputError({}, "a chunk of another size than stated");
  return {bytes.begin(), bytes.end()};
}

Bytes unpack_zstd(std::span<const std::uint8_t> bytes) {
  const unsigned long long size = ZSTD_getFrameContentSize(bytes.data(), bytes.size());
  if (size == ZSTD_CONTENTSIZE_UNKNOWN || size == ZSTD_CONTENTSIZE_ERROR)
    throw InputError({}, "a message that is no zstd frame with its size");
  return from_zstd(bytes, size);
}

Bytes pack(std::string_view compression, Bytes bytes) {
  if (compression.empty()) return bytes;
  const bool zstd = compression == "zstd";
  constexpr int level = 3;  // zstd's own default
  Bytes out(zstd ? ZSTD_compressBound(bytes.size()) : LZ4F_compressFrameBound(bytes.size(), nullptr));
  const std::size_t size = zstd ? ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), level)
                                : LZ4F_compressFrame(out.data(), out.size(), bytes.data(), bytes.size(), nullptr);
  if ((zstd ? ZSTD_isError(size) : LZ4F_isError(size)) != 0) throw InternalError("a chunk cannot be compressed");
  out.resize(size);
  return out;
}

}  // namespace plumbline::slam
