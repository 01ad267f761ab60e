// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "bim/digest/digest.h"
#include "bim/random/stream.h"

namespace plumbline::bim {

/// The random numbers of one room or piece, one after the other, by its id: they do not depend on others.
class Draws {
 public:
  Draws(const Stream& stream, std::string_view id) : stream_(stream), tick_(Digest().add(id).value()) {}

  /// Uniform in [low, high).
  double between(double low, double high) { return low + (high - low) * stream_.uniform(tick_, 0, next_++); }
  /// 0 to count - 1; count is at least 1.
  std::size_t below(std::size_t count) {
    const auto i = static_cast<std::size_t>(between(0.0, 1.0) * static_cast<double>(count));
    return i < count ? i : count - 1;
  }

 private:
  Stream stream_;
  std::uint64_t tick_;
  std::uint32_t next_ = 0;
};

}  // namespace plumbline::bim
