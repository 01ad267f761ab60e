// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/estimate/map_points.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "scenarios/report/palette.h"
#include "scenarios/report/svg.h"

namespace plumbline::scenarios {

namespace {

constexpr double least_cell_m = 0.05, layer_m = 0.25;
constexpr int most_cells = 400;  // a side
constexpr int layers = 64;

/// Which layers of height a cell has points in, a bit each; what is higher counts to the last.
using Layers = std::uint64_t;

struct CellGrid {
  Eigen::Vector2d min = Eigen::Vector2d::Zero();
  double cell_m = least_cell_m;
  int columns = 0, rows = 0;
  std::vector<Layers> cells;

  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
  }
  [[nodiscard]] Layers at(int column, int row) const { return cells[index(column, row)]; }
};

/// A floor and a ceiling fill two layers that lie apart, a wall fills several near each other: three of six.
bool is_upright(Layers cell) {
  constexpr Layers window = 0b111111;
  constexpr int least = 3;
  for (; cell != 0; cell >>= 1)
    if (std::popcount(cell & window) >= least) return true;
  return false;
}

double cell_size(const MapBox& box) {
  const double longest = (box.max - box.min).maxCoeff();
  double size = least_cell_m;
  for (const double factor : {2.0, 2.0, 2.5})
    if (size * most_cells < longest) size *= factor;
  while (size * most_cells < longest) size *= 2.0;
  return size;
}

CellGrid grid_of(const std::vector<Eigen::Vector3f>& points_F, const MapBox& box) {
  CellGrid grid;
  grid.min = box.min;
  grid.cell_m = cell_size(box);
  const auto count = [&](double length) {
    const double cells = std::ceil(length / grid.cell_m);
    return cells >= 1.0 && cells <= most_cells ? static_cast<int>(cells) : most_cells;
  };
  grid.columns = count(box.max.x() - box.min.x());
  grid.rows = count(box.max.y() - box.min.y());
  grid.cells.assign(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows), 0);
  float lowest = points_F.front().z();
  for (const Eigen::Vector3f& p : points_F) lowest = std::min(lowest, p.z());
  for (const Eigen::Vector3f& p : points_F) {
    const double x = std::floor((p.x() - grid.min.x()) / grid.cell_m),
                 y = std::floor((p.y() - grid.min.y()) / grid.cell_m);
    if (!(x >= 0.0 && y >= 0.0 && x < grid.columns && y < grid.rows)) continue;
    const double layer = std::clamp(std::floor((p.z() - lowest) / layer_m), 0.0, layers - 1.0);
    grid.cells[grid.index(static_cast<int>(x), static_cast<int>(y))] |= Layers{1} << static_cast<int>(layer);
  }
  return grid;
}

/// Cells of one kind as level strokes, each as long as there are such cells beside each other.
std::string strokes(const CellGrid& grid, bool upright) {
  std::string d;
  for (int row = 0; row < grid.rows; ++row) {
    int start = -1;
    for (int column = 0; column <= grid.columns; ++column) {
      const bool is_kind =
          column < grid.columns && grid.at(column, row) != 0 && is_upright(grid.at(column, row)) == upright;
      if (is_kind && start < 0) start = column;
      if (is_kind || start < 0) continue;
      d += "M" + std::to_string(start) + " " + std::to_string(-row) + "h" + std::to_string(column - start);
      start = -1;
    }
  }
  return d;
}

std::string path_of(const CellGrid& grid, bool upright, const std::string& ink) {
  const std::string d = strokes(grid, upright);
  return d.empty() ? "" : "<path fill=\"none\" stroke-width=\"1\" " + ink + " d=\"" + d + "\"/>";
}

}  // namespace

MapBox box_of_points(const std::vector<Eigen::Vector3f>& points_F) {
  MapBox box;
  if (points_F.empty()) return box;
  constexpr std::size_t left_out = 200;  // one in so many at each end
  for (int axis = 0; axis < 2; ++axis) {
    std::vector<float> values;
    values.reserve(points_F.size());
    for (const Eigen::Vector3f& p : points_F) values.push_back(p[axis]);
    std::sort(values.begin(), values.end());
    const std::size_t beyond = values.size() / left_out;
    box.min[axis] = values[beyond];
    box.max[axis] = values[values.size() - 1 - beyond];
  }
  return box;
}

std::string draw_map_points(const std::vector<Eigen::Vector3f>& points_F, const MapBox& box, bool over_plan) {
  if (points_F.empty()) return "";
  const CellGrid grid = grid_of(points_F, box);
  // A stroke lies in the middle of its row.
  const double half = 0.5 * grid.cell_m;
  return "<g transform=\"translate(" + svg::number(grid.min.x()) + " " + svg::number(-(grid.min.y() + half)) +
         ") scale(" + svg::number(grid.cell_m) + ")\">" +
         (over_plan ? path_of(grid, true, "stroke=\"" + method_ink(0) + "\" stroke-opacity=\".35\"")
                    : path_of(grid, false, "stroke=\"var(--thing)\" stroke-opacity=\".5\"") +
                          path_of(grid, true, "stroke=\"var(--wall)\" stroke-opacity=\".6\"")) +
         "</g>";
}

}  // namespace plumbline::scenarios
