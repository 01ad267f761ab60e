// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <emmintrin.h>

namespace plumbline::slam {

/// Four numbers side by side; every operation is rounded by itself, so the bits are the same on every CPU.
using Float4 = float __attribute__((vector_size(16)));
/// All bits of a lane set or none, as comparisons give it.
using Mask4 = int __attribute__((vector_size(16)));
using Bits4 = unsigned __attribute__((vector_size(16)));

[[nodiscard]] inline Float4 all(float value) { return Float4{value, value, value, value}; }
[[nodiscard]] inline Float4 choose(Mask4 mask, Float4 yes, Float4 no) { return mask ? yes : no; }
/// Bit i is set where lane i is.
[[nodiscard]] inline int lanes(Mask4 mask) { return _mm_movemask_ps(reinterpret_cast<__m128>(mask)); }

/// Adding so large a number rounds to whole ones.
inline constexpr float rounder = 12582912.0F;
/// The nearest whole number of what lies within 2^22.
[[nodiscard]] inline Float4 whole_of(Float4 x) { return (x + rounder) - rounder; }

/// exp(x) for x from -80 to 80, to 3e-7 of its size; anything beyond.
[[nodiscard]] inline Float4 exp_of(Float4 x) {
  // x = (whole + rest) ln 2 with rest from -1/2 to 1/2.
  const Float4 shifted = x * 1.44269504F + rounder;
  const Float4 whole = shifted - rounder;
  // ln 2 in two parts, the first of so few digits that its product is exact.
  const Float4 rest = (x - whole * 0.693359375F) + whole * 2.12194440e-4F;
  Float4 power = all(1.0F / 720.0F);
  power = power * rest + 1.0F / 120.0F;
  power = power * rest + 1.0F / 24.0F;
  power = power * rest + 1.0F / 6.0F;
  power = power * rest + 0.5F;
  power = power * rest + 1.0F;
  power = power * rest + 1.0F;
  const Bits4 exponent = (reinterpret_cast<Bits4>(shifted) - 0x4B400000U) << 23;  // wraps where x is beyond
  return reinterpret_cast<Float4>(reinterpret_cast<Bits4>(power) + exponent);
}

}  // namespace plumbline::slam
