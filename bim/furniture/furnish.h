// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "bim/config/visit.h"
#include "bim/furniture/piece.h"
#include "bim/model/building.h"

namespace plumbline::bim {

struct FurnishOptions {
  double density = 0.15;
  std::uint64_t seed = 1;
  int people = 0;

  template <class V>
  void visit(V& v) {
    v("density", density,
      plain_field("share of each room's floor that stands under furniture, as far as the room stays walkable",
                  {.min = 0.0, .max = 0.4, .basic = true}));
    v("seed", seed, plain_field("seed from which furniture is chosen and placed", {.min = 0, .max = 9.2e18}));
    v("people", people,
      plain_field("number of people that sit in the building, each in place of a chair", {.min = 0, .max = 50}));
  }
};

/// What furniture must suit besides the building.
struct FurnishSites {
  /// By storey: the one whose furniture it repeats, or -1. It gets none of its own, and what stands on it is in the way
  /// there too. Empty: none repeats another.
  std::vector<int> repeats;
  const Building* as_built = nullptr;  ///< what is built otherwise is in the way too, and its doors stay free
};

/// Furniture for every room of the building, by what its name or its size says it is for, in the order of rooms.
/// - Pieces keep 5 cm from walls, columns, obstacles and one another.
/// - In front of doors, other passages and open edges, and before and behind stairs, the floor stays free.
/// - On a grid of 0.1 m, what a robot of radius 0.4 m could reach in the room stays connected, and it can turn
/// somewhere.
/// - Floor that walls shut off from doors, passages and stairs, such as the inside of a shaft, gets none.
/// - Density falls short where this leaves no place, and in rooms above 200 m x 200 m.
/// - A person takes the place of a chair, so there are no more people than chairs.
/// - The layout of a room depends on the seed, its id and what is in it alone.
[[nodiscard]] std::vector<FurniturePiece> furnish_pieces(const Building& building, const FurnishOptions& options,
                                                         const FurnishSites& sites = {});

/// "few_chairs" where not all people found a chair among the pieces.
[[nodiscard]] std::optional<Warning> chairs_missing(const std::vector<FurniturePiece>& pieces,
                                                    const FurnishOptions& options);

/// Furniture for every room, as planned obstacles of kind "furniture", with ids "furniture_<n>" unused in the building.
[[nodiscard]] std::vector<Obstacle> furnish(const Building& building, const FurnishOptions& options);

}  // namespace plumbline::bim
