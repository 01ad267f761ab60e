// SPDX-License-Identifier: Apache-2.0
#include "scenarios/shrink/ddmin.h"

#include <algorithm>
#include <numeric>

namespace plumbline::scenarios {

namespace {

/// What is left without one of `chunks` chunks of equal size.
Kept without_chunk(const Kept& parts, std::size_t chunks, std::size_t chunk) {
  const auto begin = static_cast<std::ptrdiff_t>(chunk * parts.size() / chunks);
  const auto end = static_cast<std::ptrdiff_t>((chunk + 1) * parts.size() / chunks);
  Kept rest(parts.begin(), parts.begin() + begin);
  rest.insert(rest.end(), parts.begin() + end, parts.end());
  return rest;
}

}  // namespace

Kept minimize(std::size_t count, const FirstFailing& first_failing) {
  Kept parts(count);
  std::iota(parts.begin(), parts.end(), std::size_t{0});
  if (count == 0) return {};
  const FirstFailure none = first_failing({1, [](std::size_t) { return Kept(); }});
  if (none.index) return {};
  bool tries_left = !none.no_try_left;
  std::size_t chunks = 2, next = 0;  // chunk `next` is left out first
  while (parts.size() > 1 && tries_left) {
    chunks = std::min(chunks, parts.size());
    const auto at = [&](std::size_t i) { return without_chunk(parts, chunks, (next + i) % chunks); };
    const FirstFailure first = first_failing({chunks, at});
    tries_left = !first.no_try_left;
    if (first.index) {
      parts = at(*first.index);
      // Those before it were needed with more around them, so they come last.
      next = chunks > 2 ? (next + *first.index) % chunks : 0;
      chunks = std::max<std::size_t>(chunks - 1, 2);
    } else if (chunks == parts.size()) {
      break;
    } else {
      chunks *= 2;
      next = 0;
    }
  }
  return parts;
}

}  // namespace plumbline::scenarios
