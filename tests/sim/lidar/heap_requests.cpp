// SPDX-License-Identifier: Apache-2.0
#include "tests/sim/lidar/heap_requests.h"

#include <cstdlib>
#include <new>

namespace {

thread_local std::size_t requests = 0;

}  // namespace

void* operator new(std::size_t size) {
  ++requests;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace plumbline {

std::size_t heap_requests() { return requests; }

}  // namespace plumbline
