// SPDX-License-Identifier: Apache-2.0
#include "sim/route/route.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "bim/errors.h"
#include "sim/route/clearance_map.h"
#include "sim/route/obstacle_footprint.h"

namespace plumbline::sim {

namespace {

constexpr double margin_m = 1.0;            // around the rooms: their walls, and a step outside
constexpr double on_outline_m = 0.1;        // a place less far inside a room lies on its outline, to two cells
constexpr double thin_m = 2.0;              // walls within so little stand on one side of the floor
constexpr double cells_max = 16'777'216.0;  // 2^24, 200 m x 200 m of 5 cm cells

/// Grid over the rooms of a storey, or over its walls where there are no rooms, or over its floor where these stand in
/// one line or not at all.
GridFrame make_grid(const bim::Building& building, int storey, double cell) {
  Eigen::AlignedBox2d box;
  for (const bim::Room& room : building.rooms)
    if (room.storey == storey)
      for (const Eigen::Vector2d& p : room.polygon) box.extend(p);
  if (box.isEmpty()) {
    for (const bim::Wall& wall : building.walls)
      if (wall.storey == storey) box.extend(wall.a).extend(wall.b);
  }
  if (box.isEmpty() || box.sizes().minCoeff() < thin_m) {
    for (const bim::Slab& slab : building.slabs)
      for (const Eigen::Vector2d& p : slab.polygon.outer)
        if (slab.storey == storey) box.extend(p);
  }
  if (box.isEmpty()) return {};
  const Eigen::Vector2d cells = ((box.sizes().array() + 2.0 * margin_m) / cell).ceil();
  if (!(cells.prod() <= cells_max))
    throw InputError({}, "storey '" + building.storeys[static_cast<std::size_t>(storey)].id +
                             "' is too large to plan a route on; at most 200 m by 200 m would be right");
  return {box.min() - Eigen::Vector2d::Constant(margin_m), cell, static_cast<int>(cells.x()),
          static_cast<int>(cells.y())};
}

}  // namespace

ClearanceMap::ClearanceMap(const bim::Building& as_built, int storey, const RouteConfig& config) : config_(config) {
  const bim::WalkedFloors floors = bim::walked_floors(as_built, storey);
  ground_W_ = floors.ground_m;
  grid_ = make_grid(as_built, storey, config.cell_m);
  floor_ = floor_cells(as_built, storey, ground_W_, grid_, config);
  heights_ = floor_heights(floors, grid_, config, floor_);
  clearance_ = heights_.empty() ? clearances(grid_, find_obstacle_footprints(as_built, ground_W_, config), floor_)
                                : clearances_over(as_built, storey, floors, grid_, config, floor_, heights_);
  close_pockets(hollow_obstacles(as_built, ground_W_, config));
}

void ClearanceMap::close_pockets(const std::vector<Polygon2>& hollow_obstacles) {
  if (hollow_obstacles.empty()) return;
  const double cells_max = config_.furniture_max_m2 / (config_.cell_m * config_.cell_m);
  std::vector<char> seen(grid_.size(), 0);
  for (std::size_t cell = 0; cell < clearance_.size(); ++cell) {
    if (seen[cell] != 0 || !passable(cell)) continue;
    const std::vector<std::size_t> cells = cells_in_reach(cell, seen);
    if (static_cast<double>(cells.size()) > cells_max) continue;
    const bool shut_in = std::any_of(hollow_obstacles.begin(), hollow_obstacles.end(), [&](const Polygon2& hull) {
      return std::all_of(cells.begin(), cells.end(), [&](std::size_t c) { return contains(hull, grid_.center(c)); });
    });
    if (!shut_in) continue;
    for (const std::size_t c : cells) clearance_[c] = 0.0;
  }
}

double ClearanceMap::clearance(const Eigen::Vector2d& p) const {
  if (!grid_.find(p)) return 0.0;
  // Between the centres of the four cells around p.
  const Eigen::Vector2d g = (p - grid_.origin) / grid_.cell - Eigen::Vector2d::Constant(0.5);
  const int ix = std::clamp(static_cast<int>(std::floor(g.x())), 0, std::max(0, grid_.nx - 2));
  const int iy = std::clamp(static_cast<int>(std::floor(g.y())), 0, std::max(0, grid_.ny - 2));
  const double u = std::clamp(g.x() - ix, 0.0, 1.0);
  const double v = std::clamp(g.y() - iy, 0.0, 1.0);
  const auto at = [&](int jx, int jy) {
    return clearance_[grid_.index(std::min(jx, grid_.nx - 1), std::min(jy, grid_.ny - 1))];
  };
  return (1.0 - v) * ((1.0 - u) * at(ix, iy) + u * at(ix + 1, iy)) +
         v * ((1.0 - u) * at(ix, iy + 1) + u * at(ix + 1, iy + 1));
}

bool ClearanceMap::free(const Eigen::Vector2d& p) const { return clearance(p) >= clearance_min(); }

template <class Use>
void ClearanceMap::for_cells_around(const bim::Room& room, const Use& use) const {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : room.polygon) box.extend(p);
  if (box.isEmpty() || grid_.size() == 0) return;
  for (int j = std::max(0, grid_.row(box.min().y())); j <= std::min(grid_.ny - 1, grid_.row(box.max().y())); ++j)
    for (int i = std::max(0, grid_.column(box.min().x())); i <= std::min(grid_.nx - 1, grid_.column(box.max().x()));
         ++i)
      use(grid_.index(i, j));
}

std::optional<std::size_t> ClearanceMap::freest_cell(const bim::Room& room) const {
  if (const std::vector<std::size_t> cells = target_cells(room); !cells.empty()) return cells.front();
  std::optional<std::size_t> best;
  for_cells_around(room, [&](std::size_t cell) {
    if (best && clearance_[cell] <= clearance_[*best]) return;
    if (room.contains(grid_.center(cell))) best = cell;
  });
  return best;
}

std::size_t ClearanceMap::innermost(const bim::Room& room, std::size_t freest) const {
  std::size_t best = freest;
  double best_depth_m = 0.0;  // up to well inside
  for_cells_around(room, [&](std::size_t cell) {
    if (!turnable(cell) || regions()[cell] != regions()[freest] || !room.contains(grid_.center(cell))) return;
    const double depth = std::min(room.boundary_distance(grid_.center(cell)), config_.inside_m);
    if (std::pair(depth, clearance_[cell]) <= std::pair(best_depth_m, clearance_[best])) return;
    best = cell;
    best_depth_m = depth;
  });
  return clearance_[best] >= std::min<double>(clearance_[freest], config_.comfort_m) ? best : freest;
}

std::size_t ClearanceMap::well_inside(const bim::Room& room, std::size_t freest) const {
  // The open end of a corridor is a good place to walk through; without walls every side is open.
  const bool is_open = room.walls.empty() && room.boundary_distance(grid_.center(freest)) < on_outline_m;
  return is_open ? innermost(room, freest) : freest;
}

std::vector<std::size_t> ClearanceMap::target_cells(const bim::Room& room) const {
  struct Piece {
    std::size_t place = 0;
    std::ptrdiff_t here = 0;       // cells in the room
    std::ptrdiff_t elsewhere = 0;  // cells out of it
  };
  std::map<int, Piece> pieces;
  for_cells_around(room, [&](std::size_t cell) {
    if (!turnable(cell)) return;
    const auto known = pieces.find(regions()[cell]);
    if (known != pieces.end() && clearance_[cell] <= clearance_[known->second.place]) return;
    if (room.contains(grid_.center(cell))) pieces[regions()[cell]].place = cell;
  });
  for (auto& [region, piece] : pieces) piece.place = well_inside(room, piece.place);
  if (pieces.size() > 1) {
    for (const int region : regions())
      if (const auto found = pieces.find(region); found != pieces.end()) ++found->second.elsewhere;
    for_cells_around(room, [&](std::size_t cell) {
      const auto found = pieces.find(regions()[cell]);
      if (found == pieces.end() || !room.contains(grid_.center(cell))) return;
      ++found->second.here;
      --found->second.elsewhere;
    });
  }
  std::vector<Piece> order;
  for (const auto& [region, piece] : pieces) order.push_back(piece);
  std::stable_sort(order.begin(), order.end(), [](const Piece& a, const Piece& b) {
    return std::pair(a.elsewhere > 0, a.here) > std::pair(b.elsewhere > 0, b.here);
  });
  std::vector<std::size_t> cells;
  for (const Piece& piece : order) cells.push_back(piece.place);
  return cells;
}

std::vector<Eigen::Vector2d> ClearanceMap::room_targets(const bim::Room& room) const {
  std::vector<Eigen::Vector2d> points;
  for (const std::size_t cell : target_cells(room)) points.push_back(grid_.center(cell));
  return points;
}

Eigen::Vector2d ClearanceMap::inner_target(const bim::Room& room, const Eigen::Vector2d& target) const {
  const std::optional<std::size_t> cell = grid_.find(target);
  return cell ? grid_.center(innermost(room, *cell)) : target;
}

std::vector<Eigen::Vector2d> ClearanceMap::open_target() const {
  std::vector<char> seen(grid_.size(), 0);
  std::vector<std::size_t> largest;
  for (std::size_t cell = 0; cell < clearance_.size(); ++cell) {
    if (seen[cell] != 0 || !turnable(cell)) continue;
    std::vector<std::size_t> cells = cells_in_reach(cell, seen);
    if (cells.size() > largest.size()) largest = std::move(cells);
  }
  if (largest.empty()) return {};
  return {grid_.center(*std::min_element(largest.begin(), largest.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(-clearance_[a], a) < std::pair(-clearance_[b], b);
  }))};
}

}  // namespace plumbline::sim
