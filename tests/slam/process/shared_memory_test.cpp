// SPDX-License-Identifier: Apache-2.0
#include "slam/process/shared_memory.h"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

namespace plumbline::slam {
namespace {

TEST(SharedMemory, IsReadByWhoMapsItsFile) {
  constexpr std::size_t size = 1U << 16U;
  const SharedMemory memory(size);
  ASSERT_EQ(memory.bytes().size(), size);
  memory.bytes()[4711] = std::byte{42};
  void* other = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, memory.descriptor(), 0);
  ASSERT_NE(other, MAP_FAILED);
  EXPECT_EQ(static_cast<const std::byte*>(other)[4711], std::byte{42});
  ::munmap(other, size);
}

TEST(SharedMemory, CannotBeCutOffUnderTheWriter) {
  const SharedMemory memory(1U << 16U);
  EXPECT_NE(::ftruncate(memory.descriptor(), 0), 0);
  EXPECT_NE(::ftruncate(memory.descriptor(), 1U << 20U), 0);
}

TEST(SharedMemory, OfASizeThatNoSystemGivesIsNone) {
  const SharedMemory memory(std::size_t{1} << 62U);
  EXPECT_TRUE(memory.bytes().empty());
  EXPECT_EQ(memory.descriptor(), -1);
}

}  // namespace
}  // namespace plumbline::slam
