// SPDX-License-Identifier: Apache-2.0
#include "sim/route/clearance_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "bim/geometry/interval.h"
#include "bim/model/floors.h"
#include "bim/model/wall_frame.h"

namespace plumbline::sim {

namespace {

constexpr float slope_level_m = 0.05F;

std::vector<Segment2> outline_of(const PolygonWithHoles2& polygon) {
  std::vector<Segment2> outline;
  const auto add = [&](const Polygon2& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) outline.push_back({ring[i], ring[(i + 1) % ring.size()]});
  };
  add(polygon.outer);
  for (const Polygon2& hole : polygon.holes) add(hole);
  return outline;
}

/// Sets every cell within `reach` cells of a cell of the wanted value, first along x, then along y.
std::vector<char> spread(const GridFrame& grid, std::vector<char> cells, char value, int reach) {
  for (const bool along_x : {true, false}) {
    const std::vector<char> before = cells;
    for (int iy = 0; iy < grid.ny; ++iy) {
      for (int ix = 0; ix < grid.nx; ++ix) {
        if (before[grid.index(ix, iy)] != value) continue;
        for (int k = -reach; k <= reach; ++k) {
          const int jx = along_x ? ix + k : ix;
          const int jy = along_x ? iy : iy + k;
          if (grid.holds(jx, jy)) cells[grid.index(jx, jy)] = value;
        }
      }
    }
  }
  return cells;
}

/// Nearest edge so far of every cell.
class Nearest {
 public:
  Nearest(const GridFrame& grid, const std::vector<Segment2>& edges)
      : grid_(grid), edges_(edges), edge_(grid.size(), -1), distance_(grid.size(), std::numeric_limits<double>::max()) {
    for (std::size_t i = 0; i < edges.size(); ++i) seed(static_cast<int>(i));
  }

  /// Hands nearest edges on to neighbours until nothing changes.
  void sweep() {
    bool changed = true;
    while (changed) {
      changed = false;
      for (int iy = 0; iy < grid_.ny; ++iy) changed = sweep_row(iy, -1) || changed;
      for (int iy = grid_.ny - 1; iy >= 0; --iy) changed = sweep_row(iy, 1) || changed;
    }
  }

  [[nodiscard]] const std::vector<double>& distance() const { return distance_; }

 private:
  bool offer(std::size_t cell, const Eigen::Vector2d& center, int edge) {
    if (edge < 0 || edge == edge_[cell]) return false;
    const Segment2& s = edges_[static_cast<std::size_t>(edge)];
    const double d = segment_distance(s.a, s.b, center);
    if (d > distance_[cell] || (d == distance_[cell] && edge > edge_[cell])) return false;
    distance_[cell] = d;
    edge_[cell] = edge;
    return true;
  }

  /// Offers an edge to all cells along it.
  void seed(int edge) {
    const Segment2& s = edges_[static_cast<std::size_t>(edge)];
    const int steps = 1 + static_cast<int>(2.0 * (s.b - s.a).norm() / grid_.cell);
    for (int i = 0; i <= steps; ++i) {
      const Eigen::Vector2d p = s.a + (s.b - s.a) * (static_cast<double>(i) / steps);
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const int ix = grid_.column(p.x()) + dx;
          const int iy = grid_.row(p.y()) + dy;
          if (grid_.holds(ix, iy)) offer(grid_.index(ix, iy), grid_.center(ix, iy), edge);
        }
      }
    }
  }

  /// Takes over from the row at iy + side and, in both directions, along the row.
  bool sweep_row(int iy, int side) {
    bool changed = false;
    const auto take = [&](int ix, int dx, int dy) {
      if (!grid_.holds(ix + dx, iy + dy)) return;
      changed = offer(grid_.index(ix, iy), grid_.center(ix, iy), edge_[grid_.index(ix + dx, iy + dy)]) || changed;
    };
    for (int ix = 0; ix < grid_.nx; ++ix) {
      for (int dx = -1; dx <= 1; ++dx) take(ix, dx, side);
      take(ix, -1, 0);
    }
    for (int ix = grid_.nx - 1; ix >= 0; --ix) take(ix, 1, 0);
    return changed;
  }

  const GridFrame& grid_;
  const std::vector<Segment2>& edges_;
  std::vector<int> edge_;
  std::vector<double> distance_;
};

/// Cells off the floor next to cells on it, as edges without length.
void add_floor_border(const GridFrame& grid, const std::vector<char>& floor, std::vector<Segment2>& edges) {
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) {
      if (floor[grid.index(ix, iy)] != 0) continue;
      const auto carries = [&](int jx, int jy) { return grid.holds(jx, jy) && floor[grid.index(jx, jy)] != 0; };
      if (carries(ix - 1, iy) || carries(ix + 1, iy) || carries(ix, iy - 1) || carries(ix, iy + 1))
        edges.push_back({grid.center(ix, iy), grid.center(ix, iy)});
    }
  }
}

}  // namespace

void fill_cells(const GridFrame& grid, const std::vector<Segment2>& outline,
                const std::function<void(std::size_t)>& visit) {
  if (outline.empty()) return;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Segment2& s : outline) {
    low = std::min({low, s.a.y(), s.b.y()});
    high = std::max({high, s.a.y(), s.b.y()});
  }
  std::vector<double> crossings;
  const int last = std::min(grid.ny - 1, grid.row(high));
  for (int iy = std::max(0, grid.row(low)); iy <= last; ++iy) {
    const double y = grid.center(0, iy).y();
    crossings.clear();
    for (const Segment2& s : outline)
      if ((s.a.y() > y) != (s.b.y() > y))
        crossings.push_back(s.a.x() + (s.b.x() - s.a.x()) * ((y - s.a.y()) / (s.b.y() - s.a.y())));
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t k = 0; k + 1 < crossings.size(); k += 2) {
      // A centre is inside when crossings[k] <= x < crossings[k + 1].
      const int from = std::max(0, grid.column(crossings[k] + 0.5 * grid.cell));
      const int to = std::min(grid.nx, grid.column(crossings[k + 1] + 0.5 * grid.cell));
      for (int ix = from; ix < to; ++ix) visit(grid.index(ix, iy));
    }
  }
}

namespace {

/// True where something is overhead: a ceiling, a roof, the head of a door.
std::vector<char> covered_cells(const bim::Building& building, double floor_z, const GridFrame& grid,
                                const RouteConfig& config) {
  std::vector<char> covered(grid.size(), 0);
  const auto cover = [&](const std::vector<Segment2>& outline) {
    fill_cells(grid, outline, [&](std::size_t cell) { covered[cell] = 1; });
  };
  const double low = floor_z + config.overhead_low_m, high = floor_z + config.overhead_high_m;
  for (const bim::Slab& slab : building.slabs)
    if (slab.z0_m > low && slab.z0_m < high) cover(outline_of(slab.polygon));
  for (const bim::Obstacle& obstacle : building.obstacles)
    for (const Eigen::Vector3i& triangle : obstacle.body.triangles) {
      std::array<Eigen::Vector3d, 3> p;
      for (int k = 0; k < 3; ++k)
        p[static_cast<std::size_t>(k)] = obstacle.body.vertices[static_cast<std::size_t>(triangle[k])];
      const auto [z0, z1] = std::minmax({p[0].z(), p[1].z(), p[2].z()});
      if (z0 < low || z1 > high) continue;
      cover({{p[0].head<2>(), p[1].head<2>()}, {p[1].head<2>(), p[2].head<2>()}, {p[2].head<2>(), p[0].head<2>()}});
    }
  return covered;
}

/// Where no rooms are known, inside is where something is overhead: the floor outside is no floor then.
void keep_inside(const bim::Building& building, double floor_z, const GridFrame& grid, const RouteConfig& config,
                 std::vector<char>& floor) {
  const int reach = static_cast<int>(config.floor_gap_m / grid.cell + 0.5);
  const std::vector<char> covered =
      spread(grid, spread(grid, covered_cells(building, floor_z, grid, config), 1, reach), 0, reach);
  std::size_t inside = 0;
  for (std::size_t i = 0; i < floor.size(); ++i) inside += floor[i] != 0 && covered[i] != 0 ? 1U : 0U;
  if (static_cast<double>(inside) * grid.cell * grid.cell < config.inside_min_m2) return;
  for (std::size_t i = 0; i < floor.size(); ++i)
    if (covered[i] == 0) floor[i] = 0;
}

/// Heights of a slab's top at which it carries the robot.
struct FloorBand {
  double low = 0.0, high = 0.0;

  FloorBand(double ground_W, const RouteConfig& config)
      : low(ground_W - config.floor_below_m), high(ground_W + config.band_low_m) {}
  [[nodiscard]] bool holds(double z) const { return z >= low && z <= high; }
};

/// Faces in the band of slabs whose highest corner lies over it: an uneven top is floor where it is low enough.
std::vector<bim::FloorPiece> low_faces(const bim::Building& building, const FloorBand& band) {
  const auto reaches_over = [&](const bim::Slab& slab) {
    return !slab.assumed && slab.body && slab.z1_m > band.high && slab.z0_m < band.high;
  };
  // Looking for floors costs more than the rest; the tops of most slabs are level.
  if (std::none_of(building.slabs.begin(), building.slabs.end(), reaches_over)) return {};
  std::vector<bim::FloorPiece> pieces = bim::floor_pieces(building);
  std::erase_if(pieces, [&](const bim::FloorPiece& piece) {
    if (piece.source != bim::FloorSource::slab ||
        !reaches_over(building.slabs[static_cast<std::size_t>(piece.element)]))
      return true;
    Interval z;
    for (const Eigen::Vector2d& p : piece.polygon.outer) z.add(piece.z_at(p));
    return z.high < band.low || z.low > band.high;
  });
  return pieces;
}

}  // namespace

bool has_known_floor(const bim::Building& building, int storey, double ground_W, const RouteConfig& config) {
  const FloorBand band(ground_W, config);
  return std::any_of(building.slabs.begin(), building.slabs.end(),
                     [&](const bim::Slab& slab) { return !slab.assumed && band.holds(slab.z1_m); }) ||
         !low_faces(building, band).empty() ||
         std::any_of(building.rooms.begin(), building.rooms.end(),
                     [&](const bim::Room& room) { return room.storey == storey; });
}

std::vector<char> floor_cells(const bim::Building& building, int storey, double ground_W, const GridFrame& grid,
                              const RouteConfig& config) {
  std::vector<char> cells(grid.size(), 0);
  const auto set = [&](std::size_t cell) { cells[cell] = 1; };
  const FloorBand band(ground_W, config);
  bool any = false;
  for (const bim::Slab& slab : building.slabs) {
    if (!band.holds(slab.z1_m)) continue;
    fill_cells(grid, outline_of(slab.polygon), set);
    any = true;
  }
  for (const bim::FloorPiece& piece : low_faces(building, band)) {
    fill_cells(grid, outline_of(piece.polygon), [&](std::size_t cell) {
      if (band.holds(piece.z_at(grid.center(cell)))) cells[cell] = 1;
    });
    any = true;
  }
  if (!any)
    for (const bim::Room& room : building.rooms)
      if (room.storey == storey) fill_cells(grid, outline_of(room.outline()), set);
  if (!has_known_floor(building, storey, ground_W, config)) std::fill(cells.begin(), cells.end(), char{1});
  const int reach = static_cast<int>(config.floor_gap_m / grid.cell + 0.5);
  cells = spread(grid, spread(grid, std::move(cells), 1, reach), 0, reach);
  if (building.rooms.empty()) keep_inside(building, ground_W, grid, config, cells);
  return cells;
}

std::vector<double> clearances(const GridFrame& grid, const std::vector<ObstacleFootprint>& footprints,
                               const std::vector<char>& floor, const std::vector<Segment2>& more_edges) {
  std::vector<Segment2> edges = more_edges;
  for (const ObstacleFootprint& b : footprints) edges.insert(edges.end(), b.edges.begin(), b.edges.end());
  add_floor_border(grid, floor, edges);
  Nearest nearest(grid, edges);
  nearest.sweep();
  std::vector<double> result = nearest.distance();
  for (const ObstacleFootprint& b : footprints) {
    for (const std::vector<Segment2>& section : b.sections) {
      fill_cells(grid, section, [&](std::size_t cell) {
        const Eigen::Vector2d p = grid.center(cell);
        if (std::none_of(b.gaps.begin(), b.gaps.end(), [&](const Gap& gap) { return gap.holds(p); }))
          result[cell] = 0.0;
      });
    }
  }
  for (std::size_t i = 0; i < result.size(); ++i)
    if (floor[i] == 0) result[i] = 0.0;
  return result;
}

std::vector<float> floor_heights(const bim::WalkedFloors& floors, const GridFrame& grid, const RouteConfig& config,
                                 std::vector<char>& floor) {
  if (floors.raised.empty()) return {};
  constexpr float unknown = -1.0F;
  std::vector<float> heights(grid.size(), unknown);
  for (std::size_t i = 0; i < floor.size(); ++i)
    if (floor[i] != 0) heights[i] = 0.0F;
  for (const bim::RaisedFloor& piece : floors.raised)
    fill_cells(grid, outline_of(piece.polygon), [&](std::size_t cell) {
      heights[cell] = static_cast<float>(std::round((piece.z_at(grid.center(cell)) - floors.ground_m) * 100.0) / 100.0);
      floor[cell] = 1;
    });
  // Gaps under walls that the floor steps over are as high as the nearest floor: the first found, by rows and columns.
  const int reach = static_cast<int>(config.floor_gap_m / grid.cell + 0.5);
  std::vector<char> closed = spread(grid, spread(grid, floor, 1, reach), 0, reach);
  for (std::size_t i = 0; i < floor.size(); ++i) {
    if (floor[i] != 0 || closed[i] == 0) continue;
    const auto [column, row] = grid.column_and_row(i);
    for (int ring = 1; ring <= 2 * reach && heights[i] < 0.0F; ++ring)
      for (const auto& [dx, dy] : {std::pair{-ring, 0}, {ring, 0}, {0, -ring}, {0, ring}})
        if (heights[i] < 0.0F && grid.holds(column + dx, row + dy) && floor[grid.index(column + dx, row + dy)] != 0)
          heights[i] = heights[grid.index(column + dx, row + dy)];
    if (heights[i] < 0.0F) closed[i] = 0;
  }
  floor = std::move(closed);
  return heights;
}

std::vector<double> clearances_over(const bim::Building& building, int storey, const bim::WalkedFloors& floors,
                                    const GridFrame& grid, const RouteConfig& config, const std::vector<char>& floor,
                                    const std::vector<float>& heights) {
  const double elevation = building.storeys.at(static_cast<std::size_t>(storey)).elevation_m;
  const double ground = floors.ground_m;
  bim::Building solid = building;  // a slab or ramp that is floor is no obstacle of the floor beside it
  std::erase_if(solid.slabs, [&](const bim::Slab& slab) {
    return slab.z1_m > ground && slab.z1_m <= elevation + bim::WalkedFloorConfig().highest_m;
  });
  for (const bim::RaisedFloor& raised : floors.raised)
    if (raised.obstacle >= 0) solid.obstacles[static_cast<std::size_t>(raised.obstacle)].body = {};
  const bool slopes = std::any_of(floors.raised.begin(), floors.raised.end(),
                                  [](const bim::RaisedFloor& raised) { return !raised.is_level(); });
  // What is an obstacle from a slope is looked for every few centimetres.
  const auto level_of = [&](float height) {
    return slopes ? std::round(height / slope_level_m) * slope_level_m : height;
  };
  // From below, a door to a raised floor begins where its threshold rises: that is a step, and no sill.
  std::vector<std::size_t> doors_up;
  for (std::size_t i = 0; i < solid.openings.size(); ++i) {
    const bim::Opening& o = solid.openings[i];
    if (o.wall < 0 || !(o.z0_m > ground + config.sill_max_m)) continue;
    const bim::Wall& wall = solid.walls[static_cast<std::size_t>(o.wall)];
    const Interval depth = bim::depth_in_wall(o, wall);
    const auto cell = grid.find(wall.a + o.s_m * wall.direction() + (depth.low + 0.5 * depth.length()) * wall.left());
    if (cell && floor[*cell] != 0 && std::abs(static_cast<double>(heights[*cell]) - (o.z0_m - ground)) <= config.flat_m)
      doors_up.push_back(i);
  }
  std::vector<Segment2> edges;
  std::set<float> levels;
  for (std::size_t i = 0; i < floor.size(); ++i) {
    if (floor[i] == 0) continue;
    levels.insert(level_of(heights[i]));
    const auto [column, row] = grid.column_and_row(i);
    for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}}) {
      if (!grid.holds(column + dx, row + dy)) continue;
      const std::size_t next = grid.index(column + dx, row + dy);
      if (floor[next] == 0 || std::abs(heights[i] - heights[next]) <= static_cast<float>(config.climb_m)) continue;
      const Eigen::Vector2d middle = 0.5 * (grid.center(i) + grid.center(next));
      edges.push_back({middle, middle});
    }
  }
  std::vector<double> result(grid.size(), 0.0);
  for (const float level : levels) {
    for (const std::size_t i : doors_up)
      solid.openings[i].z0_m = std::min(building.openings[i].z0_m, ground + static_cast<double>(level));
    const std::vector<double> at_level =
        clearances(grid, find_obstacle_footprints(solid, ground + static_cast<double>(level), config), floor, edges);
    for (std::size_t i = 0; i < floor.size(); ++i)
      if (floor[i] != 0 && level_of(heights[i]) == level) result[i] = at_level[i];
  }
  return result;
}

}  // namespace plumbline::sim
