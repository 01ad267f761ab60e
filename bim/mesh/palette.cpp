// SPDX-License-Identifier: Apache-2.0
#include "bim/mesh/palette.h"

#include <algorithm>
#include <array>

namespace plumbline::bim {
namespace {

constexpr std::array<Colour, 8> all_colours{{{"wall", 0.80F, 0.77F, 0.70F, 1.0F},
                                             {"slab", 0.42F, 0.42F, 0.43F, 1.0F},
                                             {"column", 0.55F, 0.52F, 0.47F, 1.0F},
                                             {"stair", 0.52F, 0.36F, 0.20F, 1.0F},
                                             {"door", 0.36F, 0.18F, 0.07F, 1.0F},
                                             {"glass", 0.45F, 0.70F, 0.85F, 0.35F},
                                             {"furniture", 0.12F, 0.28F, 0.50F, 1.0F},
                                             {"other", 0.25F, 0.27F, 0.29F, 1.0F}}};

struct KindColour {
  std::string_view kind, colour;
};
constexpr std::array<KindColour, 7> obstacle_colours{{{"box", "furniture"},
                                                      {"cylinder", "furniture"},
                                                      {"door", "door"},
                                                      {"door_leaf", "door"},
                                                      {"furniture", "furniture"},
                                                      {"window", "glass"},
                                                      {"window_pane", "glass"}}};

std::string_view name_of(const Building& building, const MeshElement& element) {
  switch (element.kind) {
    case ElementKind::wall:
      return "wall";
    case ElementKind::slab:
      return "slab";
    case ElementKind::column:
      return "column";
    case ElementKind::stair:
      return "stair";
    case ElementKind::obstacle:
      break;
  }
  const auto index = static_cast<std::size_t>(element.index);
  return index < building.obstacles.size() ? colour_of(building.obstacles[index]) : "other";
}

}  // namespace

std::span<const Colour> palette() { return all_colours; }

std::string_view colour_of(const Obstacle& obstacle) {
  if (obstacle.material == "glass") return "glass";
  for (const KindColour& known : obstacle_colours)
    if (known.kind == obstacle.kind) return known.colour;
  return "other";
}

std::size_t colour_of(const Building& building, const MeshElement& element) {
  const std::string_view name = name_of(building, element);
  const auto found =
      std::find_if(all_colours.begin(), all_colours.end(), [&](const Colour& colour) { return colour.name == name; });
  return static_cast<std::size_t>(found - all_colours.begin());
}

}  // namespace plumbline::bim
