// SPDX-License-Identifier: Apache-2.0
#include "scenarios/shrink/ddmin.h"

#include <algorithm>
#include <numeric>

namespace plumbline::scenarios {

namespace {

/// What is left without the one or the other of `chunks` chunks of equal size, from chunk `first` on and around.
std::vector<Kept> complements(const Kept& parts, std::size_t chunks, std::size_t first) {
  std::vector<Kept> candidates;
  for (std::size_t i = 0; i < chunks; ++i) {
    const std::size_t chunk = (first + i) % chunks;
    const auto begin = static_cast<std::ptrdiff_t>(chunk * parts.size() / chunks);
    const auto end = static_cast<std::ptrdiff_t>((chunk + 1) * parts.size() / chunks);
    Kept rest(parts.begin(), parts.begin() + begin);
    rest.insert(rest.end(), parts.begin() + end, parts.end());
    candidates.push_back(std::move(rest));
  }
  return candidates;
}

}  // namespace

Kept minimize(std::size_t count, const FirstFailing& first_failing) {
  Kept parts(count);
  std::iota(parts.begin(), parts.end(), std::size_t{0});
  if (count == 0 || first_failing({Kept{}})) return {};
  std::size_t chunks = 2, next = 0;
  while (parts.size() > 1) {
    chunks = std::min(chunks, parts.size());
    std::vector<Kept> candidates = complements(parts, chunks, next);
    if (const std::optional<std::size_t> failing = first_failing(candidates)) {
      parts = std::move(candidates[*failing]);
      // Those before it were needed with more around them, so they come last.
      next = chunks > 2 ? (next + *failing) % chunks : 0;
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
