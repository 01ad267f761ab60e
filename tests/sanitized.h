// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace plumbline {

/// Whether a sanitizer watches the tests: code is many times slower then, and maps memory of its own.
#ifdef PLUMBLINE_SANITIZED
inline constexpr bool is_sanitized = true;
#else
inline constexpr bool is_sanitized = false;
#endif

/// How much longer than a bound a test may take. Measured: up to 15 times.
inline constexpr double slower = is_sanitized ? 30.0 : 1.0;

}  // namespace plumbline
