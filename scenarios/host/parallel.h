// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

namespace plumbline::scenarios {

/// Calls work(i) once for each i below `count`, by up to `threads` threads in no order; each call may write what
/// belongs to its i only. Throws what a call threw (of several the one with the lowest i), after all threads have
/// stopped, and Interrupted.
void for_each_index(std::size_t count, int threads, const std::function<void(std::size_t)>& work);

}  // namespace plumbline::scenarios
