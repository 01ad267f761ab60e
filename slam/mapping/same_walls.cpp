// SPDX-License-Identifier: Apache-2.0
#include "slam/mapping/same_walls.h"

#include <algorithm>

namespace plumbline::slam {

namespace {

/// Of `ids` those that the other room does not name, ascending.
std::vector<int> left_over(std::span<const int> ids, std::span<const int> other) {
  std::vector<int> left;
  for (const int id : ids)
    if (std::find(other.begin(), other.end(), id) == other.end()) left.push_back(id);
  std::sort(left.begin(), left.end());
  return left;
}

}  // namespace

std::optional<std::vector<SameWall>> same_walls(std::span<const int> known, std::span<const int> found,
                                                const WallDistance& distance) {
  const std::vector<int> gone = left_over(known, found), come = left_over(found, known);
  if (gone.size() != come.size()) return {};
  struct Match {
    double distance = 0.0;
    SameWall pair;
  };
  std::vector<Match> matches;
  for (const int a : gone)
    for (const int b : come)
      if (const double m = distance(a, b); m < 1.0) matches.push_back({m, {a, b}});
  std::stable_sort(matches.begin(), matches.end(),
                   [](const Match& p, const Match& q) { return p.distance < q.distance; });
  std::vector<SameWall> pairs;
  for (const Match& match : matches) {
    const auto taken = [&](const SameWall& p) { return p.known == match.pair.known || p.found == match.pair.found; };
    if (std::none_of(pairs.begin(), pairs.end(), taken)) pairs.push_back(match.pair);
  }
  if (pairs.size() != gone.size()) return {};
  std::sort(pairs.begin(), pairs.end(), [](const SameWall& p, const SameWall& q) { return p.known < q.known; });
  return pairs;
}

}  // namespace plumbline::slam
