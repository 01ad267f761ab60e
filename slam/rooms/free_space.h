// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "bim/config/visit.h"
#include "bim/geometry/grid_frame.h"
#include "slam/planes/plane_detector.h"
#include "slam/scan/motion.h"

namespace plumbline::slam {

struct FreeSpaceConfig {
  double cell_m = 0.1;
  double max_range_m = 12.0;
  int azimuths = 720;
  double height_low_m = 0.3;
  double height_high_m = 1.8;
  double sensor_height_m = 0.66;  ///< above the floor, from the calibration
  double wall_top_m = 1.2;
  double wall_gate_m = 0.06;
  int wall_hits = 4;
  double island_m = 0.8;
  int max_cells = 9'000'000;  ///< 300 x 300 m

  template <class V>
  void visit(V& v) {
    v("cell_m", cell_m, Field{.doc = "cell size of the free-space grid", .min = 0.02, .max = 0.5});
    // Beyond, rays of one azimuth step leave gaps wider than a cell.
    v("max_range_m", max_range_m, Field{.doc = "largest length of a free ray", .min = 1});
    v("azimuths", azimuths, Field{.doc = "free rays kept of a scan", .min = 90, .max = 100000});
    v("height_low_m", height_low_m,
      Field{.doc = "least height of a free ray's end above the floor", .min = -10, .max = 100});
    // Below a door's lintel.
    v("height_high_m", height_high_m,
      Field{.doc = "largest height of a free ray's end above the floor", .min = -10, .max = 100});
    v("wall_top_m", wall_top_m,
      Field{.doc = "least height of a wall's top above the floor; walls close cells above a sill too", .min = 0});
    v("wall_gate_m", wall_gate_m, Field{.doc = "largest distance of a return from its wall", .min = 0});
    // Two a scan.
    v("wall_hits", wall_hits,
      Field{.doc = "hits of walls after which a cell stays closed, whatever rays pass over them", .min = 1});
    // A wall between two doors is longer.
    v("island_m", island_m,
      Field{.doc = "side of the largest free-standing obstacle, such as a column, that does not shape rooms",
            .min = 0});
    v("max_cells", max_cells,
      Field{.doc = "most cells of the free-space grid; scans that need more are left out, and no room is drawn there",
            .min = 10'000,
            .max = 1'000'000'000});
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

/// Where the scan hit walls among its planes, at any height: below a window, beams pass over it.
[[nodiscard]] std::vector<Eigen::Vector3d> wall_points(const DeskewedScan& scan,
                                                       std::span<const PlaneObservation> planes,
                                                       const FreeSpaceConfig& config);

/// Free or not, per cell; unknown counts as not free.
struct FreeGrid {
  GridFrame frame;  ///< in M's xy plane
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
  /// False where the grid would have more than max_cells: then it stays as it is.
  [[nodiscard]] bool grow(const Eigen::Vector2d& low, const Eigen::Vector2d& high);

  FreeSpaceConfig config_;
  GridFrame frame_;
  std::vector<std::uint32_t> passed_, ended_, walled_;
};

}  // namespace plumbline::slam
