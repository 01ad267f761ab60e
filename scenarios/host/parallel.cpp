// SPDX-License-Identifier: Apache-2.0
#include "scenarios/host/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "bim/digest/float_mode.h"
#include "scenarios/host/interrupt.h"

namespace plumbline::scenarios {

void for_each_index(std::size_t count, int threads, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  std::atomic<bool> failed = false;
  std::mutex guard;
  std::exception_ptr failure;
  std::size_t failed_at = count;
  const auto run = [&] {
    set_float_mode();
    while (!failed) {
      const std::size_t i = next++;
      if (i >= count) return;
      try {
        check_interrupt();
        work(i);
      } catch (...) {
        const std::lock_guard lock(guard);
        if (i < failed_at) {
          failed_at = i;
          failure = std::current_exception();
        }
        failed = true;
      }
    }
  };
  {
    std::vector<std::jthread> others;
    const std::size_t wanted = std::min(count, static_cast<std::size_t>(std::max(threads, 1)));
    for (std::size_t k = 1; k < wanted; ++k) others.emplace_back(run);
    run();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace plumbline::scenarios
