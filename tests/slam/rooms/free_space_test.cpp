// SPDX-License-Identifier: Apache-2.0
#include "slam/rooms/free_space.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "bim/random/stream.h"

namespace plumbline::slam {
namespace {

TEST(FreeSpace, IslandsAreWhatAFloodFillSaysOnRandomGrids) {
  const Stream stream(2, "bim.generate");
  constexpr int nx = 41, ny = 29, most = 4;
  for (std::uint64_t trial = 0; trial < 40; ++trial) {
    FreeGrid grid{{{0.0, 0.0}, 0.1, nx, ny}, {}};
    grid.free.resize(grid.frame.size());
    for (std::size_t k = 0; k < grid.free.size(); ++k)
      grid.free[k] = stream.uniform(trial, static_cast<std::uint32_t>(k)) < 0.55 + 0.01 * static_cast<double>(trial);
    FreeGrid expected = grid;
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x) {
        std::vector<std::array<int, 2>> part = {{x, y}};
        std::vector<bool> seen(grid.free.size(), false);
        std::array<int, 4> box = {x, x, y, y};
        for (std::size_t k = 0; k < part.size(); ++k) {
          const auto [i, j] = part[k];
          if (i < 0 || j < 0 || i >= nx || j >= ny || grid.free[grid.frame.index(i, j)] != 0) continue;
          if (seen[grid.frame.index(i, j)]) continue;
          seen[grid.frame.index(i, j)] = true;
          box = {std::min(box[0], i), std::max(box[1], i), std::min(box[2], j), std::max(box[3], j)};
          for (const auto& n : {std::array{i - 1, j}, {i + 1, j}, {i, j - 1}, {i, j + 1}}) part.push_back(n);
        }
        const bool inside = box[0] > 0 && box[1] < nx - 1 && box[2] > 0 && box[3] < ny - 1;
        if (inside && box[1] - box[0] < most && box[3] - box[2] < most) expected.free[grid.frame.index(x, y)] = 1;
      }
    EXPECT_EQ(without_islands(grid, {.island_m = 0.1 * most}).free, expected.free) << trial;
  }
}

}  // namespace
}  // namespace plumbline::slam
