// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/write/global_id.h"

namespace plumbline::bim {
namespace {

constexpr std::string_view alphabet = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_$";
constexpr std::size_t length = 22;
constexpr std::uint64_t digit_mask = 63;

}  // namespace

std::string global_id(const IdBits& bits) {
  std::string text(length, '0');
  IdBits rest = bits;
  for (std::size_t i = length; i-- > 0;) {
    text[i] = alphabet[rest.low & digit_mask];
    rest.low = (rest.low >> 6U) | (rest.high << 58U);
    rest.high >>= 6U;
  }
  return text;
}

std::optional<IdBits> global_id_bits(std::string_view text) {
  if (text.size() != length || text.front() < '0' || text.front() > '3') return std::nullopt;
  IdBits bits;
  for (const char c : text) {
    const std::size_t digit = alphabet.find(c);
    if (digit == std::string_view::npos) return std::nullopt;
    bits.high = (bits.high << 6U) | (bits.low >> 58U);
    bits.low = (bits.low << 6U) | digit;
  }
  return bits;
}

}  // namespace plumbline::bim
