// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bim/config/visit.h"
#include "slam/planes/plane_detector.h"
#include "slam/scan/motion.h"

namespace plumbline::slam {

struct FreeSpaceConfig {
  double cell_m = 0.1;
  double max_range_m = 12.0;      ///< beyond, rays of one azimuth step leave gaps wider than a cell
  int azimuths = 720;             ///< rays kept of a scan
  double height_low_m = 0.3;      ///< above the floor
  double height_high_m = 1.8;     ///< below a door's lintel
  double sensor_height_m = 0.66;  ///< above the floor, from the calibration
  double wall_top_m =
      1.2;  ///< a plane that reaches this high above the floor is a wall, and closes cells above a sill too
  double wall_gate_m = 0.06;  ///< of a return to its wall
  int wall_hits = 4;          ///< of walls that close a cell, whatever passes over them; two a look
  double island_m = 0.8;      ///< free-standing obstacles within a square of this side (columns) do not shape rooms; a
                              ///< wall between two doors is longer

  template <class V>
  void visit(V& v) {
    v("cell_m", cell_m, Field{.doc = "of the free-space grid", .min = 0.02, .max = 0.5});
    v("max_range_m", max_range_m, Field{.doc = "of a free ray", .min = 1});
    v("azimuths", azimuths, Field{.doc = "free rays of a scan", .min = 90});
    v("height_low_m", height_low_m, Field{.doc = "of a free ray's end, above the floor"});
    v("height_high_m", height_high_m, Field{.doc = "of a free ray's end, above the floor"});
    v("wall_top_m", wall_top_m, Field{.doc = "least height of a wall's top above the floor", .min = 0});
    v("wall_gate_m", wall_gate_m, Field{.doc = "of a return to its wall", .min = 0});
    v("wall_hits", wall_hits, Field{.doc = "of walls that close a cell", .min = 1});
    v("island_m", island_m, Field{.doc = "smaller free-standing obstacles are ignored", .min = 0});
  }
};

/// Free space as one scan saw it: per azimuth the farthest return at robot height, so that low furniture is seen over.
struct FreeRays {
  Eigen::Vector3d origin_R = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> end_R;   ///< azimuths without a return in the band are left out
  std::vector<bool> hit;                ///< false: cut at max_range_m
  std::vector<Eigen::Vector3d> wall_R;  ///< where walls were hit, one point a half cell
};

/// up_R: the vertical in R, unit.
[[nodiscard]] FreeRays free_rays(const DeskewedScan& scan, const Eigen::Vector3d& up_R, const FreeSpaceConfig& config);

/// Where the scan hit walls among its planes, at any height: below a window, light passes over it [facts: slam 10].
[[nodiscard]] std::vector<Eigen::Vector3d> wall_points(const DeskewedScan& scan,
                                                       std::span<const PlaneObservation> planes,
                                                       const FreeSpaceConfig& config);

/// Where a grid's cells lie in M: cell (i, j) covers origin + cell * [i, i + 1) x [j, j + 1).
struct GridFrame {
  Eigen::Vector2d origin_M = Eigen::Vector2d::Zero();
  double cell = 0.1;
  int nx = 0, ny = 0;

  [[nodiscard]] std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(i);
  }
  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny); }
  /// Column and row of a cell.
  [[nodiscard]] std::array<int, 2> place(std::size_t index) const {
    // Grids are far smaller than 2^32 cells, and a division of 32 bits is the faster one.
    const auto cell32 = static_cast<std::uint32_t>(index), width = static_cast<std::uint32_t>(nx);
    return {static_cast<int>(cell32 % width), static_cast<int>(cell32 / width)};
  }
  [[nodiscard]] Eigen::Vector2d center(int i, int j) const {
    return {origin_M.x() + cell * (i + 0.5), origin_M.y() + cell * (j + 0.5)};
  }
  [[nodiscard]] Eigen::Vector2d center(std::size_t index) const {
    const auto [i, j] = place(index);
    return center(i, j);
  }
  /// Index of the cell that holds p, or -1 outside.
  [[nodiscard]] std::ptrdiff_t find(const Eigen::Vector2d& p_M) const;
};

/// Free or not, per cell; unknown counts as not free.
struct FreeGrid {
  GridFrame frame;
  std::vector<std::uint8_t> free;
};

/// Cells that are free in one grid and not in the other; both on the same lattice, whatever their extents.
[[nodiscard]] std::size_t changed_cells(const FreeGrid& before, const FreeGrid& after);

/// Fills obstacles that stand free and fit into a square of island_m.
[[nodiscard]] FreeGrid without_islands(FreeGrid grid, const FreeSpaceConfig& config);

/// Counts, per cell of M's xy plane, rays that passed, rays that ended and hits of walls.
class FreeSpaceMap {
 public:
  explicit FreeSpaceMap(const FreeSpaceConfig& config) : config_(config) { frame_.cell = config.cell_m; }

  void carve(const FreeRays& rays, const Pose& X_MR);
  void clear();
  /// A cell is free when at least twice as many rays passed as ended there and no wall was hit in it; small islands are
  /// filled.
  [[nodiscard]] FreeGrid grid() const { return without_islands(seen_free(), config_); }
  /// The same, islands and all.
  [[nodiscard]] FreeGrid seen_free() const;

 private:
  void grow(const Eigen::Vector2d& low, const Eigen::Vector2d& high);

  FreeSpaceConfig config_;
  GridFrame frame_;
  std::vector<std::uint32_t> passed_, ended_, walled_;
};

}  // namespace plumbline::slam
