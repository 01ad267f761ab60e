// SPDX-License-Identifier: Apache-2.0
#include "slam/rooms/free_space.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

namespace plumbline::slam {

namespace {

/// Visits the cells that a segment inside the grid goes through, in order; the cell of b is not visited.
template <class Visit>
void walk(const GridFrame& frame, const Eigen::Vector2d& a, const Eigen::Vector2d& b, Visit visit) {
  constexpr double never = std::numeric_limits<double>::infinity();
  const Eigen::Vector2d from = (a - frame.origin) / frame.cell, to = (b - frame.origin) / frame.cell;
  const Eigen::Vector2d way = to - from;
  const Eigen::Vector2i cell = from.cast<int>(), last = to.cast<int>();
  Eigen::Vector2d next, step;  // shares of the way to the next column and row, and between two of them
  Eigen::Vector2i left = (last - cell).cwiseAbs();
  for (int k = 0; k < 2; ++k) {
    step[k] = way[k] == 0.0 ? never : std::abs(1.0 / way[k]);
    const double rest = way[k] > 0.0 ? cell[k] + 1 - from[k] : from[k] - cell[k];
    // Where rounding would leave the way to the last cell, that axis is done.
    next[k] = left[k] == 0 ? never : rest * step[k];
  }
  const std::ptrdiff_t across[2] = {way.x() > 0.0 ? 1 : -1, way.y() > 0.0 ? frame.nx : -frame.nx};
  auto index = static_cast<std::ptrdiff_t>(frame.index(cell.x(), cell.y()));
  for (int n = left.sum(); n > 0; --n) {
    visit(static_cast<std::size_t>(index));
    const int k = next.x() < next.y() ? 0 : 1;
    index += across[k];
    next[k] = --left[k] == 0 ? never : next[k] + step[k];
  }
}

/// How many of n cells are free, in b too where it is not null. Eight at a time: a byte is 0 or 1.
std::size_t free_cells(const std::uint8_t* a, const std::uint8_t* b, std::size_t n) {
  constexpr std::size_t word = sizeof(std::uint64_t);
  std::size_t count = 0, k = 0;
  for (; k + word <= n; k += word) {
    std::uint64_t eight = 0, other = ~std::uint64_t{0};
    std::memcpy(&eight, a + k, word);
    if (b != nullptr) std::memcpy(&other, b + k, word);
    count += (eight & other) * 0x0101010101010101U >> 56U;
  }
  for (; k < n; ++k) count += b != nullptr ? a[k] & b[k] : a[k];
  return count;
}

/// Turns components of non-free cells that touch no border and fit into a square of max_cells into free space.
class Islands {
 public:
  Islands(FreeGrid& grid, int max_cells) : grid_(grid), max_cells_(max_cells), land_(grid.frame.size(), Land::unseen) {}

  void fill() {
    const GridFrame& f = grid_.frame;
    for (int j = 0; j < f.ny; ++j)
      for (int i = 0; i < f.nx; ++i) {
        const std::size_t cell = f.index(i, j);
        if (grid_.free[cell] != 0 || land_[cell] != Land::unseen) continue;
        // Nearly all that is not free hangs together with what is left of it or above it.
        const bool beside_main =
            (i > 0 && land_[cell - 1] == Land::main) || (j > 0 && land_[f.index(i, j - 1)] == Land::main);
        if (beside_main)
          land_[cell] = Land::main;
        else if (explore(i, j))
          for (const Cell& c : component_) grid_.free[f.index(c.i, c.j)] = 1;
      }
  }

 private:
  enum class Land : std::uint8_t { unseen, seen, main };
  struct Cell {
    int i = 0, j = 0;
  };

  /// Whether the component is an island. Stops where it proves to be none.
  bool explore(int i, int j) {
    const GridFrame& f = grid_.frame;
    component_.assign(1, {i, j});
    land_[f.index(i, j)] = Land::seen;
    Cell low{i, j}, high{i, j};
    bool island = true;
    for (std::size_t k = 0; k < component_.size() && island; ++k) {
      const Cell c = component_[k];
      low = {std::min(low.i, c.i), std::min(low.j, c.j)};
      high = {std::max(high.i, c.i), std::max(high.j, c.j)};
      const bool at_border = c.i == 0 || c.j == 0 || c.i + 1 == f.nx || c.j + 1 == f.ny;
      island = !at_border && std::max(high.i - low.i, high.j - low.j) < max_cells_;
      if (!island) break;
      for (const Cell n : {Cell{c.i - 1, c.j}, Cell{c.i + 1, c.j}, Cell{c.i, c.j - 1}, Cell{c.i, c.j + 1}}) {
        const std::size_t cell = f.index(n.i, n.j);
        island &= land_[cell] != Land::main;
        if (grid_.free[cell] != 0 || land_[cell] != Land::unseen) continue;
        land_[cell] = Land::seen;
        component_.push_back(n);
      }
    }
    if (!island)
      for (const Cell& c : component_) land_[f.index(c.i, c.j)] = Land::main;
    return island;
  }

  FreeGrid& grid_;
  int max_cells_;
  std::vector<Land> land_;
  std::vector<Cell> component_;
};

}  // namespace

FreeRays free_rays(const DeskewedScan& scan, const Eigen::Vector3d& up_R, const FreeSpaceConfig& config) {
  FreeRays rays;
  rays.origin_R = scan.X_RL.t;
  std::vector<double> range(static_cast<std::size_t>(config.azimuths), 0.0);
  std::vector<Eigen::Vector3d> end(range.size());
  const auto rings = static_cast<std::size_t>(scan.rings);
  for (std::size_t column = 0; column < static_cast<std::size_t>(scan.columns); ++column) {
    // The returns of one firing share its azimuth.
    std::size_t farthest = 0;
    double reach = 0.0, squared_reach = 0.0;
    for (std::size_t k = column * rings; k < (column + 1) * rings; ++k) {
      if (scan.range_m[k] <= 0.0) continue;
      const Eigen::Vector3d ray = scan.point_R[k] - rays.origin_R;
      const double rise = up_R.dot(ray);
      const double height = config.sensor_height_m + rise;
      if (height < config.height_low_m || height > config.height_high_m) continue;
      const double squared = (ray - up_R * rise).squaredNorm();
      if (squared <= squared_reach) continue;
      const double horizontal = std::sqrt(squared);
      if (horizontal <= reach) continue;  // two squares may have one root
      reach = horizontal;
      squared_reach = squared;
      farthest = k;
    }
    if (reach <= 0.0) continue;
    const Eigen::Vector3d ray = scan.point_R[farthest] - rays.origin_R;
    const double turn = std::atan2(ray.y(), ray.x()) / (2.0 * std::numbers::pi) + 0.5;
    const auto bin = std::min(static_cast<std::size_t>(turn * config.azimuths), range.size() - 1);
    if (reach <= range[bin]) continue;
    range[bin] = reach;
    end[bin] = scan.point_R[farthest];
  }
  for (std::size_t bin = 0; bin < range.size(); ++bin) {
    if (range[bin] <= 0.0) continue;
    const bool hit = range[bin] <= config.max_range_m;
    const double keep = hit ? 1.0 : config.max_range_m / range[bin];
    rays.end_R.push_back(rays.origin_R + keep * (end[bin] - rays.origin_R));
    rays.hit.push_back(hit);
  }
  return rays;
}

std::vector<Eigen::Vector3d> wall_points(const DeskewedScan& scan, std::span<const PlaneObservation> planes,
                                         const FreeSpaceConfig& config) {
  struct Wall {
    Plane plane_R;
    Eigen::Vector3d from_R, along;
    double length = 0.0;
    std::vector<std::uint8_t> hit;  ///< by stretches of a half cell
  };
  const double floor_R = scan.X_RL.t.z() - config.sensor_height_m;
  const double bin_m = 0.5 * config.cell_m;
  std::vector<Wall> walls;
  for (const PlaneObservation& plane : planes) {
    if (!plane.vertical || plane.z1 - floor_R < config.wall_top_m) continue;
    const Eigen::Vector3d way = plane.p1_R - plane.p0_R;
    const double length = way.norm();
    const auto bins = static_cast<std::size_t>(length / bin_m) + 1;
    walls.push_back({plane.plane_R, plane.p0_R, way / std::max(length, 1e-9), length,
                     std::vector<std::uint8_t>(bins, std::uint8_t{0})});
  }
  const auto rings = static_cast<std::size_t>(scan.rings), columns = static_cast<std::size_t>(scan.columns);
  for (std::size_t column = 0; column < columns; column += 2)
    for (std::size_t k = column * rings; k < (column + 1) * rings; ++k) {
      if (scan.range_m[k] <= 0.0) continue;
      const Eigen::Vector3d& p = scan.point_R[k];
      for (Wall& wall : walls) {
        if (std::abs(wall.plane_R.distance(p)) > config.wall_gate_m) continue;
        const double s = wall.along.dot(p - wall.from_R);
        if (s >= 0.0 && s <= wall.length) wall.hit[static_cast<std::size_t>(s / bin_m)] = 1;
      }
    }
  std::vector<Eigen::Vector3d> result;
  for (const Wall& wall : walls)
    for (std::size_t b = 0; b < wall.hit.size(); ++b)
      if (wall.hit[b] != 0) result.push_back(wall.from_R + wall.along * (bin_m * (static_cast<double>(b) + 0.5)));
  return result;
}

FreeGrid without_islands(FreeGrid grid, const FreeSpaceConfig& config) {
  Islands(grid, static_cast<int>(std::lround(config.island_m / grid.frame.cell))).fill();
  return grid;
}

std::size_t changed_cells(const FreeGrid& before, const FreeGrid& after) {
  const auto count = [](const FreeGrid& grid) { return free_cells(grid.free.data(), nullptr, grid.free.size()); };
  const GridFrame &f = before.frame, &g = after.frame;
  if (f.size() == 0 || g.size() == 0) return count(before) + count(after);
  const auto di = static_cast<int>(std::lround((f.origin.x() - g.origin.x()) / g.cell));
  const auto dj = static_cast<int>(std::lround((f.origin.y() - g.origin.y()) / g.cell));
  const int first = std::max(0, -di), last = std::min(f.nx, g.nx - di);
  std::size_t both = 0;
  for (int j = std::max(0, -dj); j < std::min(f.ny, g.ny - dj) && first < last; ++j)
    both += free_cells(before.free.data() + f.index(first, j), after.free.data() + g.index(first + di, j + dj),
                       static_cast<std::size_t>(last - first));
  return count(before) + count(after) - 2 * both;
}

void FreeSpaceMap::carve(const FreeRays& rays, const Pose& X_MR) {
  const Eigen::Vector2d origin = (X_MR * rays.origin_R).head<2>();
  std::vector<Eigen::Vector2d> ends;
  ends.reserve(rays.end_R.size());
  Eigen::Vector2d low = origin, high = origin;
  for (const Eigen::Vector3d& end_R : rays.end_R) {
    ends.emplace_back((X_MR * end_R).head<2>());
    low = low.cwiseMin(ends.back());
    high = high.cwiseMax(ends.back());
  }
  std::vector<Eigen::Vector2d> walls;
  walls.reserve(rays.wall_R.size());
  for (const Eigen::Vector3d& p_R : rays.wall_R) {
    walls.emplace_back((X_MR * p_R).head<2>());
    low = low.cwiseMin(walls.back());
    high = high.cwiseMax(walls.back());
  }
  if (!grow(low, high)) return;
  for (const Eigen::Vector2d& p : walls) ++walled_[*frame_.find(p)];
  for (std::size_t k = 0; k < ends.size(); ++k) {
    walk(frame_, origin, ends[k], [&](std::size_t cell) { ++passed_[cell]; });
    if (rays.hit[k]) ++ended_[*frame_.find(ends[k])];
  }
}

void FreeSpaceMap::clear() {
  frame_ = {.cell = config_.cell_m};
  passed_.clear();
  ended_.clear();
  walled_.clear();
}

FreeGrid FreeSpaceMap::seen_free() const {
  const auto wall_hits = static_cast<std::uint32_t>(config_.wall_hits);
  FreeGrid grid{frame_, std::vector<std::uint8_t>(frame_.size(), 0)};
  for (std::size_t k = 0; k < grid.free.size(); ++k)
    grid.free[k] = passed_[k] > 0 && passed_[k] >= 2 * ended_[k] && walled_[k] < wall_hits;
  return grid;
}

bool FreeSpaceMap::grow(const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
  // Grown in blocks, so that a walk does not copy the grid at every keyframe; cells stay aligned to M's origin.
  constexpr double block_cells = 32.0;
  const double block = block_cells * frame_.cell;
  const auto down = [&](double v) { return block * std::floor((v - frame_.cell) / block); };
  const auto up = [&](double v) { return block * std::ceil((v + frame_.cell) / block); };
  Eigen::Vector2d new_low(down(low.x()), down(low.y())), new_high(up(high.x()), up(high.y()));
  if (frame_.nx > 0) {
    new_low = new_low.cwiseMin(frame_.origin);
    new_high = new_high.cwiseMax(frame_.origin + frame_.cell * Eigen::Vector2d(frame_.nx, frame_.ny));
  }
  const Eigen::Vector2d cells = (new_high - new_low) / frame_.cell;
  if (!(cells.x() * cells.y() <= config_.max_cells)) return false;
  GridFrame grown = frame_;
  grown.origin = new_low;
  grown.nx = static_cast<int>(std::lround((new_high.x() - new_low.x()) / frame_.cell));
  grown.ny = static_cast<int>(std::lround((new_high.y() - new_low.y()) / frame_.cell));
  if (grown.nx == frame_.nx && grown.ny == frame_.ny) return true;
  std::vector<std::uint32_t> passed(grown.size(), 0), ended(grown.size(), 0), walled(grown.size(), 0);
  const int di = static_cast<int>(std::lround((frame_.origin.x() - new_low.x()) / frame_.cell));
  const int dj = static_cast<int>(std::lround((frame_.origin.y() - new_low.y()) / frame_.cell));
  for (int j = 0; j < frame_.ny; ++j)
    for (int i = 0; i < frame_.nx; ++i) {
      passed[grown.index(i + di, j + dj)] = passed_[frame_.index(i, j)];
      ended[grown.index(i + di, j + dj)] = ended_[frame_.index(i, j)];
      walled[grown.index(i + di, j + dj)] = walled_[frame_.index(i, j)];
    }
  frame_ = grown;
  passed_ = std::move(passed);
  ended_ = std::move(ended);
  walled_ = std::move(walled);
  return true;
}

}  // namespace plumbline::slam
