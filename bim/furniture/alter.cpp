// SPDX-License-Identifier: Apache-2.0
#include "bim/furniture/alter.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "bim/errors.h"
#include "bim/furniture/draws.h"
#include "bim/furniture/layout.h"
#include "bim/furniture/room_space.h"
#include "bim/model/boxes.h"
#include "bim/model/permanence.h"

namespace plumbline::bim {

namespace {

constexpr double moved_max_m = 0.5;
constexpr double turned_max_rad = 20.0 * std::numbers::pi / 180.0;

/// A piece as the building has it.
struct Piece {
  int obstacle = -1;
  Footprint footprint;
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  ///< of its extent, m
  int in_space = -1;                                 ///< index in its room's space
};

struct FurnishedRoom {
  int room = -1;
  std::vector<Piece> pieces;
};

bool is_furniture(const Obstacle& obstacle) { return permanence_of(obstacle) == Permanence::furniture; }

/// The room on whose floor the middle of a box stands, or -1.
int room_of(const Building& building, const Eigen::AlignedBox3d& box) {
  constexpr double below_m = 0.3;
  const Eigen::Vector2d center = box.center().head<2>();
  for (std::size_t r = 0; r < building.rooms.size(); ++r) {
    const Room& room = building.rooms[r];
    if (box.min().z() < room.z0_m - below_m || box.min().z() > room.z1_m) continue;
    if (room.contains(center)) return static_cast<int>(r);
  }
  return -1;
}

/// Rooms with furniture, ascending, each with its pieces in the order of the building.
std::vector<FurnishedRoom> furnished_rooms(const Building& building, const WalkableConfig& config) {
  std::vector<FurnishedRoom> rooms(building.rooms.size());
  for (std::size_t i = 0; i < building.obstacles.size(); ++i) {
    const Solid& body = building.obstacles[i].body;
    if (!is_furniture(building.obstacles[i]) || body.vertices.empty()) continue;
    const int room = room_of(building, box_of(body));
    if (room < 0) continue;
    const double floor_z = building.rooms[static_cast<std::size_t>(room)].z0_m;
    Piece piece;
    piece.obstacle = static_cast<int>(i);
    piece.footprint = footprint_of(body, floor_z + config.band_low_m, floor_z + config.band_high_m);
    piece.center = box_of(body).center().head<2>();
    rooms[static_cast<std::size_t>(room)].pieces.push_back(std::move(piece));
  }
  for (std::size_t r = 0; r < rooms.size(); ++r) rooms[r].room = static_cast<int>(r);
  std::erase_if(rooms, [](const FurnishedRoom& room) { return room.pieces.empty(); });
  return rooms;
}

/// The directed rectangle of a piece: along the longest edge of what it covers, of equal ones the first.
FurniturePiece rectangle_of(const Piece& piece) {
  Eigen::Vector2d x = Eigen::Vector2d::UnitX();
  double longest = 0.0;
  for (const Polygon2& part : piece.footprint.parts)
    for (std::size_t i = 0; i < part.size(); ++i) {
      const Eigen::Vector2d edge = part[(i + 1) % part.size()] - part[i];
      if (edge.norm() <= longest + 1e-6) continue;
      longest = edge.norm();
      x = edge.normalized();
    }
  const Eigen::Vector2d y(-x.y(), x.x());
  Eigen::AlignedBox2d box;
  for (const Polygon2& part : piece.footprint.parts)
    for (const Eigen::Vector2d& p : part) box.extend(Eigen::Vector2d(p.dot(x), p.dot(y)));
  FurniturePiece found;
  found.at = box.center().x() * x + box.center().y() * y;
  found.size = box.sizes();
  found.yaw_deg = std::atan2(x.y(), x.x()) * 180.0 / std::numbers::pi;
  return found;
}

/// Changes a building, room by room.
class Alteration {
 public:
  Alteration(Building& building, std::uint64_t seed)
      : building_(building),
        stream_(seed, "bim.furniture.alter"),
        surroundings_(building),
        rooms_(furnished_rooms(building, WalkableConfig{})) {
    ids_.take(building);
    for (std::size_t i = 0; i < building.obstacles.size(); ++i)
      if (is_furniture(building.obstacles[i])) furniture_.push_back(static_cast<int>(i));
  }

  FurnitureChanges run(FurnitureWorld world) {
    if (world == FurnitureWorld::swapped) choose_swapped();
    for (FurnishedRoom& furnished : rooms_) {
      RoomSpace space = space_of(furnished, world != FurnitureWorld::unknown);
      if (!space.walkable()) continue;
      if (world == FurnitureWorld::moved) move_pieces(furnished, space);
      if (world == FurnitureWorld::swapped) swap_pieces(furnished, space);
      if (world == FurnitureWorld::more) add_pieces(furnished, space);
      if (world == FurnitureWorld::unknown) lay_out_anew(furnished, space);
    }
    if (world == FurnitureWorld::unknown) gone_.insert(furniture_.begin(), furniture_.end());
    if (world == FurnitureWorld::swapped) take_away_outside();
    finish();
    changes_.gone = static_cast<int>(gone_.size()) - changes_.swapped;
    return changes_;
  }

 private:
  [[nodiscard]] Room& room_of_piece(const FurnishedRoom& furnished) const {
    return building_.rooms[static_cast<std::size_t>(furnished.room)];
  }
  [[nodiscard]] const Obstacle& obstacle(const Piece& piece) const {
    return building_.obstacles[static_cast<std::size_t>(piece.obstacle)];
  }

  RoomSpace space_of(FurnishedRoom& furnished, bool with_pieces) {
    const Room& room = room_of_piece(furnished);
    RoomSpace space(room);
    for (Footprint& footprint : surroundings_.near(space.box(), room.z0_m, furniture_, space.config()))
      space.add(std::move(footprint));
    space.keep_clear(keep_clear(building_, room, room.z0_m, space.config()));
    space.leave_out_shut_off();
    if (with_pieces)
      for (Piece& piece : furnished.pieces) piece.in_space = space.add(piece.footprint);
    return space;
  }

  void move_pieces(FurnishedRoom& furnished, RoomSpace& space) {
    constexpr int tries = 60;
    for (Piece& piece : furnished.pieces) {
      if (piece.footprint.parts.empty()) continue;
      Draws draws(stream_, obstacle(piece).id);
      space.remove(piece.in_space);
      Footprint stands = piece.footprint;
      for (int i = 0; i < tries; ++i) {
        // Uniform over the disc.
        const double far = moved_max_m * std::sqrt(draws.between(0.0, 1.0));
        const double to = draws.between(0.0, 2.0 * std::numbers::pi);
        const double yaw = draws.between(-turned_max_rad, turned_max_rad);
        const Eigen::Vector2d by = far * Eigen::Vector2d(std::cos(to), std::sin(to));
        Footprint there = moved(piece.footprint, piece.center, yaw, by);
        if (!space.holds(there) || !space.stays_walkable(there)) continue;
        move_solid(piece, yaw, by);
        stands = std::move(there);
        ++changes_.moved;
        break;
      }
      piece.in_space = space.add(std::move(stands));
    }
  }

  void move_solid(const Piece& piece, double yaw, const Eigen::Vector2d& by) {
    const Eigen::Rotation2Dd turn(yaw);
    for (Eigen::Vector3d& p : building_.obstacles[static_cast<std::size_t>(piece.obstacle)].body.vertices)
      p.head<2>() = (piece.center + turn * Eigen::Vector2d(p.head<2>() - piece.center) + by).eval();
  }

  /// A third of all, by a number drawn for each.
  void choose_swapped() {
    std::vector<std::pair<std::uint64_t, int>> order;
    for (const int i : furniture_)
      order.emplace_back(stream_.bits(Digest().add(building_.obstacles[static_cast<std::size_t>(i)].id).value(), 1), i);
    std::sort(order.begin(), order.end());
    order.resize((order.size() + 1) / 3);
    for (const auto& [number, i] : order) chosen_.insert(i);
  }

  void swap_pieces(FurnishedRoom& furnished, RoomSpace& space) {
    for (const Piece& piece : furnished.pieces) {
      if (!chosen_.contains(piece.obstacle)) continue;
      gone_.insert(piece.obstacle);
      space.remove(piece.in_space);
      Draws draws(stream_, obstacle(piece).id);
      if (draws.below(2) == 0 || piece.footprint.parts.empty()) continue;
      if (std::optional<FurniturePiece> other = replacement(furnished, piece, space, draws)) {
        space.add(footprint_of(*other));
        add(std::move(*other));
        ++changes_.swapped;
      }
    }
  }

  /// Another shape at the place, no larger than what stood there, or none that fits.
  std::optional<FurniturePiece> replacement(const FurnishedRoom& furnished, const Piece& piece, RoomSpace& space,
                                            Draws& draws) const {
    struct Other {
      FurnitureShape shape;
      double height_m;
    };
    constexpr std::array<Other, 6> others = {{{FurnitureShape::table, 0.74},
                                              {FurnitureShape::shelf, 1.8},
                                              {FurnitureShape::wardrobe, 2.0},
                                              {FurnitureShape::sofa, 0.85},
                                              {FurnitureShape::chair, 0.9},
                                              {FurnitureShape::pallet, 0.9}}};
    constexpr double size_min_m = 0.25, other_height_m = 0.1;
    const Room& room = room_of_piece(furnished);
    const double height = box_of(obstacle(piece).body).sizes().z();
    FurniturePiece result = rectangle_of(piece);
    const std::size_t first = draws.below(others.size());
    const double scale = draws.between(0.7, 1.0);
    result.size = (scale * result.size).cwiseMax(size_min_m);
    result.storey = room.storey;
    result.room = furnished.room;
    result.floor_z_m = room.z0_m;
    for (std::size_t k = 0; k < others.size(); ++k) {
      const Other& other = others[(first + k) % others.size()];
      if (std::abs(other.height_m - height) < other_height_m) continue;  // may be the same shape
      result.shape = other.shape;
      result.height_m = std::min(other.height_m, std::max(0.3, room.z1_m - room.z0_m - 0.1));
      const Footprint footprint = footprint_of(result);
      if (space.holds(footprint) && space.stays_walkable(footprint)) return result;
      return std::nullopt;  // all others cover the same
    }
    return std::nullopt;
  }

  /// Chosen pieces outside rooms can only go.
  void take_away_outside() { gone_.insert(chosen_.begin(), chosen_.end()); }

  void add_pieces(const FurnishedRoom& furnished, RoomSpace& space) {
    const Room& room = room_of_piece(furnished);
    Draws draws(stream_, room.id);
    LayoutOrder order{space.floor_m2(), static_cast<int>(furnished.pieces.size())};
    for (FurniturePiece& piece : lay_out(room, space, order, draws)) add_new(furnished, std::move(piece));
  }

  void lay_out_anew(const FurnishedRoom& furnished, RoomSpace& space) {
    const Room& room = room_of_piece(furnished);
    Draws draws(stream_, room.id);
    LayoutOrder order;
    for (const Piece& piece : furnished.pieces)
      if (!piece.footprint.parts.empty()) order.target_m2 += rectangle_of(piece).size.prod();
    order.target_m2 = std::min(order.target_m2, space.floor_m2());
    for (FurniturePiece& piece : lay_out(room, space, order, draws)) add_new(furnished, std::move(piece));
  }

  void add_new(const FurnishedRoom& furnished, FurniturePiece piece) {
    piece.room = furnished.room;
    add(std::move(piece));
    ++changes_.added;
  }

  void add(FurniturePiece piece) {
    piece.id = ids_.next();
    Obstacle obstacle = obstacle_of(piece);
    obstacle.planned = false;
    added_.push_back(std::move(obstacle));
  }

  /// Takes away what is gone; what is new follows what was there.
  void finish() {
    std::vector<Obstacle> kept;
    for (std::size_t i = 0; i < building_.obstacles.size(); ++i)
      if (!gone_.contains(static_cast<int>(i))) kept.push_back(std::move(building_.obstacles[i]));
    kept.insert(kept.end(), std::make_move_iterator(added_.begin()), std::make_move_iterator(added_.end()));
    building_.obstacles = std::move(kept);
  }

  Building& building_;
  Stream stream_;
  Surroundings surroundings_;
  std::vector<FurnishedRoom> rooms_;
  FurnitureIds ids_;
  std::vector<int> furniture_;  ///< indices of obstacles, ascending
  std::set<int> chosen_, gone_;
  std::vector<Obstacle> added_;
  FurnitureChanges changes_;
};

}  // namespace

FurnitureChanges alter_furniture(Building& as_built, FurnitureWorld world, std::uint64_t seed) {
  if (world == FurnitureWorld::as_planned) return {};
  return Alteration(as_built, seed).run(world);
}

}  // namespace plumbline::bim
