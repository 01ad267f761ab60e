// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "bim/digest/digest.h"

namespace plumbline::bim {

using Digests = std::vector<std::uint64_t>;

inline std::string one_line(const Digests& digests) {
  Digest all;
  for (const std::uint64_t digest : digests) all.add(digest);
  return all.hex();
}

/// Prints a row of ci/results/same_bits.tsv.
inline void print_row(const std::string& way, double mrays, const Digests& digests) {
  std::printf("same_bits\t%s\t%.1f\t%s\n", way.c_str(), mrays, one_line(digests).c_str());
}

/// Expects another process to find what this one finds; gives what this one found.
inline Digests expect_same_in_another_process(const std::function<Digests()>& digests) {
  int channel[2];
  EXPECT_EQ(::pipe(channel), 0);
  const pid_t child = ::fork();
  EXPECT_GE(child, 0);
  if (child == 0) {
    const std::string text = one_line(digests());
    const bool written = ::write(channel[1], text.data(), text.size()) == static_cast<ssize_t>(text.size());
    _exit(written ? 0 : 1);
  }
  ::close(channel[1]);
  const Digests own = digests();
  std::array<char, 16> theirs{};
  int status = 1;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(::read(channel[0], theirs.data(), theirs.size()), 16);
  ::close(channel[0]);
  EXPECT_EQ(std::string(theirs.data(), theirs.size()), one_line(own));
  return own;
}

}  // namespace plumbline::bim
