// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace plumbline {

/// How often this thread of the test program has called operator new.
[[nodiscard]] std::size_t heap_requests();

}  // namespace plumbline
