// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace plumbline {

/// Sets this thread's floating-point mode: round to nearest, flush-to-zero and denormals-are-zero on. main and every
/// thread and task call it on entry, because Embree changes it for its own tasks.
void set_float_mode();
/// MXCSR of this thread without its sticky exception flags.
[[nodiscard]] unsigned float_mode();
/// The value set_float_mode() sets.
inline constexpr unsigned required_float_mode = 0x9fc0;

}  // namespace plumbline
