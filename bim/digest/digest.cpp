// SPDX-License-Identifier: Apache-2.0
#include "bim/digest/digest.h"

#include <bit>
#include <cmath>

#include "bim/errors.h"

namespace plumbline {

namespace {

/// Bijective finaliser of 64 bits (the constants of MurmurHash3's fmix64).
std::uint64_t mix(std::uint64_t x) {
  x ^= x >> 33U;
  x *= 0xff51afd7ed558ccdULL;
  x ^= x >> 33U;
  x *= 0xc4ceb9fe1a85ec53ULL;
  return x ^ (x >> 33U);
}

}  // namespace

Digest& Digest::add(std::uint64_t value) {
  state_ = mix(state_ * 0x9e3779b97f4a7c15ULL + mix(value));
  return *this;
}

Digest& Digest::add(std::int64_t value) { return add(std::bit_cast<std::uint64_t>(value)); }

Digest& Digest::add(double value) {
  if (std::isnan(value)) throw InternalError("digest: a stage produced a value that is not a number");
  return add(std::bit_cast<std::uint64_t>(value == 0.0 ? 0.0 : value));
}

Digest& Digest::add(std::string_view text) {
  add(static_cast<std::uint64_t>(text.size()));
  for (const char c : text) add(static_cast<std::uint64_t>(static_cast<unsigned char>(c)));
  return *this;
}

Digest& Digest::add(const Pose& X) { return add(X.t).add(X.q.w()).add(X.q.x()).add(X.q.y()).add(X.q.z()); }

Digest& Digest::add(const Plane& plane) { return add(plane.n).add(plane.d); }

Digest& Digest::add(std::span<const double> values) {
  for (const double v : values) add(v);
  return *this;
}

Digest& Digest::add_bytes(std::span<const std::uint8_t> bytes) {
  std::uint64_t word = 0;
  int filled = 0;
  for (const std::uint8_t b : bytes) {
    word = (word << 8U) | b;
    if (++filled == 8) {
      add(word);
      word = 0;
      filled = 0;
    }
  }
  if (filled > 0) add(word);
  return add(static_cast<std::uint64_t>(bytes.size()));
}

std::string Digest::hex() const { return hex64(state_); }

std::string hex64(std::uint64_t value) {
  static constexpr char digits[] = "0123456789abcdef";
  std::string text(16, '0');
  for (int i = 15; i >= 0; --i, value >>= 4U) text[static_cast<std::size_t>(i)] = digits[value & 15U];
  return text;
}

}  // namespace plumbline
