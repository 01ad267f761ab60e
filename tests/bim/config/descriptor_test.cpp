// SPDX-License-Identifier: Apache-2.0
#include "bim/config/descriptor.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <string>
#include <utility>

namespace plumbline {
namespace {

bool is_open(int fd) { return ::fcntl(fd, F_GETFD) >= 0; }

TEST(DescriptorTest, IsClosedOnceByTheLastOwner) {
  int fd = -1;
  {
    Descriptor second;
    {
      Descriptor first(::open("/dev/null", O_RDONLY | O_CLOEXEC));
      fd = first.get();
      ASSERT_TRUE(is_open(fd));
      second = std::move(first);
    }
    EXPECT_EQ(second.get(), fd);
    EXPECT_TRUE(is_open(fd));
    const Descriptor third(std::move(second));
    EXPECT_TRUE(is_open(fd));
  }
  EXPECT_FALSE(is_open(fd));
  Descriptor none;
  EXPECT_EQ(none.close_now(), 0);
}

TEST(DescriptorTest, AllIsWrittenOrItSaysNot) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe2(ends.data(), O_CLOEXEC), 0);
  Descriptor from(ends[0]);
  const Descriptor to(ends[1]);
  EXPECT_TRUE(write_all(to.get(), "four"));
  std::array<char, 8> read{};
  EXPECT_EQ(std::string(read.data(), static_cast<std::size_t>(::read(from.get(), read.data(), read.size()))), "four");
  from.close_now();
  const auto before = std::signal(SIGPIPE, SIG_IGN);
  EXPECT_FALSE(write_all(to.get(), "nobody reads"));
  (void)std::signal(SIGPIPE, before);
}

}  // namespace
}  // namespace plumbline
