// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace plumbline::sim {

/// Lengths of steps between cells, in tenths of a cell: 10 and 14, near 1 : sqrt 2.
inline constexpr std::int64_t straight_step = 10;
inline constexpr std::int64_t diagonal_step = 14;

struct GridStep {
  int dx = 0;
  int dy = 0;
  std::int64_t length = 0;
};

/// To the eight neighbours of a cell.
inline constexpr std::array<GridStep, 8> grid_steps = {{{1, 0, straight_step},
                                                        {0, 1, straight_step},
                                                        {-1, 0, straight_step},
                                                        {0, -1, straight_step},
                                                        {1, 1, diagonal_step},
                                                        {-1, 1, diagonal_step},
                                                        {-1, -1, diagonal_step},
                                                        {1, -1, diagonal_step}}};

/// Queue of cells by their cost for searches that look at most cells of a large grid: a step costs at most so much, so
/// that as many buckets hold all that is open [dial1969]. Of equal costs the one pushed last comes first.
class BucketQueue {
 public:
  /// Costs of a step: whole numbers from 0 to widest_step.
  explicit BucketQueue(std::int64_t widest_step) : buckets_(static_cast<std::size_t>(widest_step) + 1) {}

  [[nodiscard]] bool empty() const { return count_ == 0; }
  /// cost: no less than that of the last cell popped, and by no more than a step above it.
  void push(std::int64_t cost, std::size_t cell) {
    buckets_[static_cast<std::size_t>(cost) % buckets_.size()].push_back(static_cast<std::uint32_t>(cell));
    ++count_;
  }
  [[nodiscard]] std::pair<std::int64_t, std::size_t> pop() {
    while (buckets_[static_cast<std::size_t>(cost_) % buckets_.size()].empty()) ++cost_;
    std::vector<std::uint32_t>& bucket = buckets_[static_cast<std::size_t>(cost_) % buckets_.size()];
    const std::size_t cell = bucket.back();
    bucket.pop_back();
    --count_;
    return {cost_, cell};
  }

 private:
  std::vector<std::vector<std::uint32_t>> buckets_;
  std::int64_t cost_ = 0;
  std::size_t count_ = 0;
};

}  // namespace plumbline::sim
