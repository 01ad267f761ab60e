// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace plumbline::slam {

/// Two vertices that a room shows to be one wall, by their ids.
struct SameWall {
  int known = 0, found = 0;
  friend bool operator==(const SameWall&, const SameWall&) = default;
};

/// Squared Mahalanobis distance of two wall vertices over that of its gate; above 1: two walls.
using WallDistance = std::function<double(int known, int found)>;

/// A room that is seen again and a known one are the same when every wall is [bavle2023, section IV-C]: by its id, or,
/// where the ids differ, within the gate (best fit first, ties: lower ids), one to one. Then the pairs whose ids
/// differ, by `known`, which are duplicates; nothing where the rooms are two.
[[nodiscard]] std::optional<std::vector<SameWall>> same_walls(std::span<const int> known, std::span<const int> found,
                                                              const WallDistance& distance);

}  // namespace plumbline::slam
