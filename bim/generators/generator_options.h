// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "bim/config/visit.h"
#include "bim/formats/plan_yaml/plan_symmetry.h"

namespace plumbline::bim {

/// Which sides of a corridor have rooms.
enum class Sides { one, both };
[[nodiscard]] constexpr std::array<std::string_view, 2> names_of(Sides) { return {"one", "both"}; }
enum class RoomShape { l, trapezoid, chamfer };
[[nodiscard]] constexpr std::array<std::string_view, 3> names_of(RoomShape) { return {"l", "trapezoid", "chamfer"}; }

/// Options of every family of buildings.
struct GeneratorOptions {
  std::optional<std::uint64_t> seed;
  double epsilon_m = 0.0;
  FeatureKind feature = FeatureKind::none;
  bool feature_visible = true;
  bool glass = false;
  double height_m = 3.0;
  double facade_m = 0.24;
  double partition_m = 0.12;
  double door_m = 1.0;

  template <class V>
  void visit(V& v) {
    v("seed", seed, plain_field("seed from which the sizes that are not given are drawn", {.min = 0, .max = 9.2e18}));
    v("epsilon_m", epsilon_m,
      Field{.doc = "size of the distinguishing feature; 0: none, else at least 0.02 m", .min = 0.0, .max = 0.5});
    v("feature", feature, Field{.doc = "kind of the distinguishing feature"});
    v("feature_visible", feature_visible, Field{.doc = "whether the feature can be seen from the start room"});
    v("glass", glass, Field{.doc = "whether partitions are of glass, which the LiDAR sees through"});
    v("height_m", height_m, Field{.doc = "height of a storey from floor to ceiling", .min = 2.3, .max = 10.0});
    v("facade_m", facade_m, Field{.doc = "thickness of outer walls", .min = 0.1, .max = 0.6});
    v("partition_m", partition_m, Field{.doc = "thickness of inner walls", .min = 0.05, .max = 0.4});
    v("door_m", door_m, Field{.doc = "clear width of doors", .min = 0.9, .max = 1.5});
  }
};

}  // namespace plumbline::bim
