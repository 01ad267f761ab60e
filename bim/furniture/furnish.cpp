// SPDX-License-Identifier: Apache-2.0
#include "bim/furniture/furnish.h"

#include <algorithm>
#include <utility>

#include "bim/furniture/draws.h"
#include "bim/furniture/layout.h"
#include "bim/furniture/room_space.h"

namespace plumbline::bim {

namespace {

constexpr std::size_t pieces_max = 15000;  ///< in a building

/// Floors, by the buildings as planned and as built.
class Site {
 public:
  Site(const Building& building, const FurnishSites& sites) : building_(building), sites_(sites) {
    floors_.push_back({&building, Surroundings(building)});
    if (sites.as_built != nullptr) floors_.push_back({sites.as_built, Surroundings(*sites.as_built)});
  }

  [[nodiscard]] bool is_repeated(int storey) const { return repeated_by(storey) >= 0; }

  /// The room's floor with all that stands there, and on the storeys that repeat its own.
  [[nodiscard]] RoomSpace space_of(const Room& room) const {
    RoomSpace space(room);
    if (!space.walkable()) return space;
    for (const double z : levels_of(room))
      for (const auto& [building, surroundings] : floors_) {
        for (Footprint& footprint : surroundings.near(space.box(), z, {}, space.config()))
          space.add(std::move(footprint));
        space.keep_clear(keep_clear(*building, room, z, space.config()));
      }
    space.leave_out_shut_off();
    return space;
  }

 private:
  [[nodiscard]] int repeated_by(int storey) const {
    return storey >= 0 && std::cmp_less(storey, sites_.repeats.size())
               ? sites_.repeats[static_cast<std::size_t>(storey)]
               : -1;
  }

  [[nodiscard]] std::vector<double> levels_of(const Room& room) const {
    std::vector<double> levels = {room.z0_m};
    for (std::size_t s = 0; s < building_.storeys.size(); ++s)
      if (room.storey >= 0 && repeated_by(static_cast<int>(s)) == room.storey)
        levels.push_back(room.z0_m + building_.storeys[s].elevation_m -
                         building_.storeys[static_cast<std::size_t>(room.storey)].elevation_m);
    return levels;
  }

  const Building& building_;
  const FurnishSites& sites_;
  std::vector<std::pair<const Building*, Surroundings>> floors_;
};

bool is_habitable(const Building& building, int storey) {
  return storey < 0 || building.storeys[static_cast<std::size_t>(storey)].kind == StoreyKind::habitable;
}

/// People take the places of chairs drawn from all.
void seat_people(std::vector<FurniturePiece>& pieces, const FurnishOptions& options) {
  constexpr double sitting_m = 1.28;
  const Stream stream(options.seed, "bim.furniture.people");
  std::vector<std::pair<std::uint64_t, std::size_t>> chairs;
  for (std::size_t i = 0; i < pieces.size(); ++i)
    if (pieces[i].shape == FurnitureShape::chair) chairs.emplace_back(stream.bits(i), i);
  std::sort(chairs.begin(), chairs.end());
  for (std::size_t k = 0; k < chairs.size() && std::cmp_less(k, options.people); ++k) {
    FurniturePiece& piece = pieces[chairs[k].second];
    piece.shape = FurnitureShape::person;
    piece.height_m = sitting_m;
  }
}

}  // namespace

std::vector<FurniturePiece> furnish_pieces(const Building& building, const FurnishOptions& options,
                                           const FurnishSites& sites) {
  std::vector<FurniturePiece> pieces;
  if (!(options.density > 0.0)) return pieces;
  const Site site(building, sites);
  const Stream stream(options.seed, "bim.furnish");
  for (std::size_t r = 0; r < building.rooms.size(); ++r) {
    const Room& room = building.rooms[r];
    if (site.is_repeated(room.storey) || !is_habitable(building, room.storey)) continue;
    RoomSpace space = site.space_of(room);
    Draws draws(stream, room.id);
    const LayoutOrder order{
        options.density * space.floor_m2(),
        static_cast<int>(std::min<std::size_t>(LayoutOrder().pieces_max, pieces_max - pieces.size()))};
    for (FurniturePiece& piece : lay_out(room, space, order, draws)) {
      piece.room = static_cast<int>(r);
      pieces.push_back(std::move(piece));
    }
  }
  seat_people(pieces, options);
  FurnitureIds ids;
  ids.take(building);
  if (sites.as_built != nullptr) ids.take(*sites.as_built);
  for (FurniturePiece& piece : pieces) piece.id = ids.next();
  return pieces;
}

std::optional<Warning> chairs_missing(const std::vector<FurniturePiece>& pieces, const FurnishOptions& options) {
  const auto seated = std::count_if(pieces.begin(), pieces.end(),
                                    [](const FurniturePiece& piece) { return piece.shape == FurnitureShape::person; });
  if (seated >= options.people) return std::nullopt;
  return Warning{"", "few_chairs",
                 "only " + std::to_string(seated) + " of the " + std::to_string(options.people) +
                     " people asked for sit, since the furniture has no more chairs; a higher density places more"};
}

std::vector<Obstacle> furnish(const Building& building, const FurnishOptions& options) {
  std::vector<Obstacle> obstacles;
  for (const FurniturePiece& piece : furnish_pieces(building, options)) obstacles.push_back(obstacle_of(piece));
  return obstacles;
}

}  // namespace plumbline::bim
