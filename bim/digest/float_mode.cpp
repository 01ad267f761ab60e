// SPDX-License-Identifier: Apache-2.0
#include "bim/digest/float_mode.h"

#include <immintrin.h>

namespace plumbline {

namespace {
constexpr unsigned sticky_flags = 0x3f;
}

void set_float_mode() { _mm_setcsr(required_float_mode); }

unsigned float_mode() { return _mm_getcsr() & ~sticky_flags; }

}  // namespace plumbline
