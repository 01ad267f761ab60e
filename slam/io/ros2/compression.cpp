// SPDX-License-Identifier: Apache-2.0
#include "slam/io/ros2/compression.h"

#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
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

using Lz4Context = std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)>;

Lz4Context lz4_context() {
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) != 0)
    throw EnvironmentError("no memory to unpack lz4 data");
  return {context, &LZ4F_freeDecompressionContext};
}

Bytes from_lz4(std::span<const std::uint8_t> bytes, std::uint64_t size) {
  constexpr std::uint64_t most_ratio = 255;  // of the format
  check_size(size, bytes.size(), most_ratio);
  Bytes out(size);
  unpack_lz4(bytes, out);
  return out;
}

/// Room grows with what comes out, since nothing else bounds it. step: of input and output, returns what they were and
/// whether it may go on.
template <class Step>
Bytes beginning(std::span<const std::uint8_t> bytes, std::uint64_t most, const Step& step) {
  constexpr std::size_t piece = std::size_t{1} << 20U;
  Bytes out;
  std::size_t at = 0;
  for (bool good = true; good && at < most;) {
    out.resize(std::min<std::uint64_t>(most, at + piece));
    std::size_t taken = bytes.size(), made = out.size() - at;
    good = step(bytes.data(), taken, out.data() + at, made);
    if (taken == 0 && made == 0) break;
    bytes = bytes.subspan(taken);
    at += made;
  }
  out.resize(at);
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

Bytes unpack_beginning(std::string_view compression, std::span<const std::uint8_t> bytes, std::uint64_t size) {
  const std::uint64_t most = std::min(size, most_unpacked_bytes);
  if (compression.empty())
    return {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(std::min<std::uint64_t>(most, bytes.size()))};
  if (compression == "zstd") {
    const std::unique_ptr<ZSTD_DStream, decltype(&ZSTD_freeDStream)> stream(ZSTD_createDStream(), &ZSTD_freeDStream);
    if (!stream) throw EnvironmentError("no memory to unpack zstd data");
    return beginning(bytes, most,
                     [&](const std::uint8_t* in, std::size_t& taken, std::uint8_t* out, std::size_t& made) {
                       ZSTD_inBuffer from{in, taken, 0};
                       ZSTD_outBuffer to{out, made, 0};
                       const std::size_t left = ZSTD_decompressStream(stream.get(), &to, &from);
                       taken = from.pos;
                       made = to.pos;
                       return left != 0 && ZSTD_isError(left) == 0;
                     });
  }
  if (compression != "lz4") return {};
  const Lz4Context context = lz4_context();
  return beginning(bytes, most, [&](const std::uint8_t* in, std::size_t& taken, std::uint8_t* out, std::size_t& made) {
    const std::size_t left = LZ4F_decompress(context.get(), out, &made, in, &taken, nullptr);
    if (LZ4F_isError(left) != 0) taken = made = 0;
    return left != 0 && LZ4F_isError(left) == 0;
  });
}

void unpack_lz4(std::span<const std::uint8_t> bytes, std::span<std::uint8_t> out) {
  const Lz4Context context = lz4_context();
  std::size_t at = 0, from = 0, left = 1;
  while (left != 0 && from < bytes.size()) {
    std::size_t room = out.size() - at, taken = bytes.size() - from;
    left = LZ4F_decompress(context.get(), out.data() + at, &room, bytes.data() + from, &taken, nullptr);
    if (LZ4F_isError(left) != 0) throw InputError({}, std::string("damaged lz4 data: ") + LZ4F_getErrorName(left));
    if (room == 0 && taken == 0) break;
    at += room;
    from += taken;
  }
  if (left != 0 || at != out.size() || from != bytes.size())
    throw InputError({}, "lz4 data of another size than stated");
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
