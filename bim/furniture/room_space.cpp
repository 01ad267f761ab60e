// SPDX-License-Identifier: Apache-2.0
#include "bim/furniture/room_space.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

namespace plumbline::bim {

RoomSpace::RoomSpace(const Room& room, WalkableConfig config)
    : config_(config),
      outline_(room.polygon),
      radius_(static_cast<float>(config.radius_m - 1e-6)),
      turn_(static_cast<float>(config.turn_m - 1e-6)),
      reach_m_(config.turn_m + 0.05) {
  for (const Eigen::Vector2d& p : outline_) box_.extend(p);
  if (outline_.size() < 3) return;
  const Eigen::Vector2d cells = box_.sizes() / config_.cell_m;
  if (!(cells.x() * cells.y() <= config_.cells_max && cells.maxCoeff() <= config_.cells_max)) return;
  grid_ = {box_.min(), config_.cell_m, static_cast<int>(cells.x()) + 1, static_cast<int>(cells.y()) + 1};
  clearance_.assign(grid_.size(), -1.0F);
  marked_.assign(grid_.size(), 0);
  find_inside(room);
  for (const Polygon2* rim : room.rims())
    for (std::size_t i = 0; i < rim->size(); ++i) add(footprint_of(Polygon2{(*rim)[i], (*rim)[(i + 1) % rim->size()]}));
}

/// Cells whose centre lies inside, by the crossings of each row.
void RoomSpace::find_inside(const Room& room) {
  for (int j = 0; j < grid_.ny; ++j) {
    const double y = grid_.center(0, j).y();
    std::vector<double> crossings;
    for (const Polygon2* rim : room.rims())
      for (std::size_t k = 0; k < rim->size(); ++k) {
        const Eigen::Vector2d &a = (*rim)[k], &b = (*rim)[(k + 1) % rim->size()];
        if ((a.y() <= y) != (b.y() <= y)) crossings.push_back(a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
      }
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t k = 0; k + 1 < crossings.size(); k += 2) {
      const int first = std::max(0, static_cast<int>(std::ceil((crossings[k] - grid_.origin.x()) / grid_.cell - 0.5)));
      for (int i = first; i < grid_.nx && grid_.center(i, j).x() < crossings[k + 1]; ++i)
        set_clearance(grid_.index(i, j), static_cast<float>(reach_m_));
    }
  }
}

void RoomSpace::set_clearance(std::size_t cell, float value) {
  free_cells_ += static_cast<int>(value >= radius_) - static_cast<int>(clearance_[cell] >= radius_);
  turning_cells_ += static_cast<int>(value >= turn_) - static_cast<int>(clearance_[cell] >= turn_);
  clearance_[cell] = value;
}

RoomSpace::CellRange RoomSpace::cells_around(const Eigen::AlignedBox2d& box) const {
  const auto clamped = [](double v, int n) { return static_cast<int>(std::clamp(std::floor(v), -1.0, n + 0.0)); };
  const Eigen::Vector2d low = (box.min() - grid_.origin).array() - reach_m_;
  const Eigen::Vector2d high = (box.max() - grid_.origin).array() + reach_m_;
  return {std::max(0, clamped(low.x() / grid_.cell, grid_.nx)),
          std::min(grid_.nx - 1, clamped(high.x() / grid_.cell, grid_.nx)),
          std::max(0, clamped(low.y() / grid_.cell, grid_.ny)),
          std::min(grid_.ny - 1, clamped(high.y() / grid_.cell, grid_.ny))};
}

void RoomSpace::lower(const Footprint& footprint) {
  for (const Polygon2& part : footprint.parts) {
    const Footprint one = footprint_of(part);
    const CellRange range = cells_around(one.box);
    for (int j = range.j0; j <= range.j1; ++j)
      for (int i = range.i0; i <= range.i1; ++i) {
        const std::size_t cell = grid_.index(i, j);
        if (clearance_[cell] <= 0.0F) continue;
        const auto d = static_cast<float>(distance(one, grid_.center(i, j)));
        if (d < clearance_[cell]) set_clearance(cell, d);
      }
  }
}

void RoomSpace::keep_clear(std::vector<Polygon2> areas) {
  clear_.insert(clear_.end(), std::make_move_iterator(areas.begin()), std::make_move_iterator(areas.end()));
}

template <class Use>
void RoomSpace::for_neighbours(std::size_t cell, const Use& use) const {
  const auto [i, j] = grid_.column_and_row(cell);
  for (const auto& [di, dj] : {std::array{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
    if (grid_.holds(i + di, j + dj)) use(grid_.index(i + di, j + dj));
}

template <class Use>
void RoomSpace::for_free_neighbours(std::size_t cell, const Use& use) const {
  for_neighbours(cell, [&](std::size_t next) {
    if (free(next)) use(next);
  });
}

/// Numbers of the pieces of floor on which the middle of something can stand, by cell; -1 elsewhere.
std::vector<int> RoomSpace::standing_pieces() const {
  constexpr float half_m = 0.15F;  // more than a cell, so that no piece reaches through a wall
  std::vector<int> piece(grid_.size(), -1);
  int count = 0;
  for (std::size_t start = 0; start < grid_.size(); ++start) {
    if (piece[start] >= 0 || clearance_[start] < half_m) continue;
    std::vector<std::size_t> cells = {start};
    piece[start] = count;
    for (std::size_t k = 0; k < cells.size(); ++k)
      for_neighbours(cells[k], [&](std::size_t next) {
        if (piece[next] >= 0 || clearance_[next] < half_m) return;
        piece[next] = count;
        cells.push_back(next);
      });
    ++count;
  }
  return piece;
}

/// Where one enters over an area: its floor nearest to its first and last corners, since it may reach through a wall
/// on the other side.
std::optional<std::size_t> RoomSpace::cell_at_entry(const Polygon2& area, const std::vector<int>& piece) const {
  std::optional<std::size_t> nearest;
  double least = 0.0;
  const CellRange range = cells_around(footprint_of(area).box);
  for (int j = range.j0; j <= range.j1; ++j)
    for (int i = range.i0; i <= range.i1; ++i) {
      const std::size_t cell = grid_.index(i, j);
      if (piece[cell] < 0 || !contains(area, grid_.center(i, j))) continue;
      const double d = segment_distance(area.front(), area.back(), grid_.center(i, j));
      if (nearest && d >= least) continue;
      nearest = cell;
      least = d;
    }
  return nearest;
}

void RoomSpace::leave_out_shut_off() {
  const std::vector<int> piece = standing_pieces();
  std::set<int> entered;
  for (const Polygon2& area : clear_)
    if (const auto cell = cell_at_entry(area, piece)) entered.insert(piece[*cell]);
  if (entered.empty()) return;
  std::vector<std::size_t> cells;
  for (std::size_t cell = 0; cell < piece.size(); ++cell)
    if (piece[cell] >= 0 && !entered.contains(piece[cell])) cells.push_back(cell);
  if (cells.empty()) return;
  shut_off_.assign(grid_.size(), 0);
  for (const std::size_t cell : cells) shut_off_[cell] = 1;
  // And the strip along what stands around it.
  constexpr int strip_cells = 2;
  for (int step = 0; step < strip_cells; ++step)
    for (std::size_t k = 0, count = cells.size(); k < count; ++k)
      for_neighbours(cells[k], [&](std::size_t next) {
        if (shut_off_[next] != 0 || clearance_[next] <= 0.0F || piece[next] >= 0) return;
        shut_off_[next] = 1;
        cells.push_back(next);
      });
  for (const std::size_t cell : cells) set_clearance(cell, -1.0F);
}

double RoomSpace::floor_m2() const {
  const auto cells = std::count(shut_off_.begin(), shut_off_.end(), 1);
  return signed_area(outline_) - static_cast<double>(cells) * grid_.cell * grid_.cell;
}

int RoomSpace::add(Footprint footprint) {
  lower(footprint);
  standing_.push_back({std::move(footprint), true});
  return static_cast<int>(standing_.size()) - 1;
}

void RoomSpace::remove(int index) {
  Standing& gone = standing_[static_cast<std::size_t>(index)];
  gone.there = false;
  if (gone.footprint.parts.empty()) return;
  const CellRange range = cells_around(gone.footprint.box);
  for (int j = range.j0; j <= range.j1; ++j)
    for (int i = range.i0; i <= range.i1; ++i)
      if (clearance_[grid_.index(i, j)] >= 0.0F) set_clearance(grid_.index(i, j), static_cast<float>(reach_m_));
  Eigen::AlignedBox2d changed = gone.footprint.box;
  changed.extend((changed.min().array() - 2.0 * reach_m_).matrix().eval());
  changed.extend((changed.max().array() + 2.0 * reach_m_).matrix().eval());
  for (const Standing& other : standing_)
    if (other.there && !other.footprint.parts.empty() && other.footprint.box.intersects(changed))
      lower(other.footprint);
}

bool RoomSpace::holds(const Footprint& footprint) const {
  constexpr double rounding_m = 1e-6;
  if (footprint.parts.empty()) return false;
  for (const Polygon2& part : footprint.parts)
    if (!contains(outline_, part.front())) return false;
  if (!shut_off_.empty())
    for (const Polygon2& part : footprint.parts)
      if (const auto cell = grid_.find(footprint_of(part).box.center()); cell && shut_off_[*cell] != 0) return false;
  for (const Standing& other : standing_)
    if (other.there && nearer_than(footprint, other.footprint, config_.gap_m - rounding_m)) return false;
  for (const Polygon2& area : clear_)
    for (const Polygon2& part : footprint.parts)
      if (nearer_than(part, area, 0.0)) return false;
  return true;
}

bool RoomSpace::stays_walkable(const Footprint& footprint) {
  std::vector<std::size_t> taken;
  std::int64_t turning = turning_cells_;
  const CellRange range = cells_around(footprint.box);
  for (int j = range.j0; j <= range.j1; ++j)
    for (int i = range.i0; i <= range.i1; ++i) {
      const std::size_t cell = grid_.index(i, j);
      if (!free(cell)) continue;
      const auto d = static_cast<float>(distance(footprint, grid_.center(i, j)));
      if (d < radius_) taken.push_back(cell);
      if (d < turn_ && clearance_[cell] >= turn_) --turning;
    }
  if (turning_cells_ > 0 && turning <= 0) return false;
  return taken.empty() || connected_without(taken);
}

/// Where a free part loses cells that hang together, its remains touch them. So it stays in one piece where all free
/// neighbours of the lost cells reach one another, and is lost whole where there are none.
bool RoomSpace::connected_without(const std::vector<std::size_t>& taken) {
  constexpr std::size_t pocket_cells = 10;  // free space this small may be lost
  const std::uint32_t lost = ++search_;
  for (const std::size_t cell : taken) marked_[cell] = lost;
  const std::uint32_t grouped = ++search_;
  for (const std::size_t start : taken) {
    if (marked_[start] == grouped) continue;
    std::vector<std::size_t> group = {start}, border;
    marked_[start] = grouped;
    const std::uint32_t bordering = ++search_;
    for (std::size_t k = 0; k < group.size(); ++k)
      for_free_neighbours(group[k], [&](std::size_t next) {
        if (marked_[next] == lost) {
          marked_[next] = grouped;
          group.push_back(next);
        } else if (marked_[next] != grouped && marked_[next] != bordering) {
          marked_[next] = bordering;
          border.push_back(next);
        }
      });
    if (border.empty() && (group.size() > pocket_cells || std::cmp_equal(group.size(), free_cells_))) return false;
    if (!all_reach_one_another(border, bordering, lost, grouped)) return false;
  }
  return true;
}

bool RoomSpace::all_reach_one_another(const std::vector<std::size_t>& border, std::uint32_t bordering,
                                      std::uint32_t lost, std::uint32_t grouped) {
  if (border.empty()) return true;
  const std::uint32_t seen = ++search_;
  std::vector<std::size_t> queue;
  std::size_t left = border.size();
  const auto visit = [&](std::size_t cell) {
    if (marked_[cell] == seen || marked_[cell] == lost || marked_[cell] == grouped) return;
    left -= marked_[cell] == bordering ? 1U : 0U;
    marked_[cell] = seen;
    queue.push_back(cell);
  };
  visit(border.front());
  for (std::size_t k = 0; k < queue.size() && left > 0; ++k) for_free_neighbours(queue[k], visit);
  return left == 0;
}

double RoomSpace::clearance(const Eigen::Vector2d& p) const {
  const auto cell = grid_.find(p);
  return cell ? static_cast<double>(clearance_[*cell]) : -1.0;
}

}  // namespace plumbline::bim
