// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/estimate/map_points.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <cstdint>
#include <span>

#include "scenarios/report/palette.h"
#include "scenarios/report/svg.h"

namespace plumbline::scenarios {

namespace {

constexpr double least_cell_m = 0.05;
constexpr int most_cells = 400;  // a side

enum class CellKind : std::uint8_t { empty, level, upright };

struct CellGrid {
  Eigen::Vector2d min = Eigen::Vector2d::Zero();
  double cell_m = least_cell_m;
  int columns = 0, rows = 0;
  std::vector<CellKind> cells;

  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
  }
  [[nodiscard]] CellKind at(int column, int row) const { return cells[index(column, row)]; }
};

/// A point by its cell and its height.
struct CellHeight {
  std::uint32_t cell = 0;
  float z = 0.0F;
  auto operator<=>(const CellHeight&) const = default;
};

/// Whether the heights of a cell, in order, are those of a wall, which has points at three heights near each other: a
/// floor and a ceiling, and a slab between two storeys, have two.
bool is_upright(std::span<const CellHeight> heights) {
  constexpr float apart_m = 0.25F, within_m = 1.5F;
  const auto next = [&](std::size_t from) {
    return static_cast<std::size_t>(
        std::partition_point(heights.begin(), heights.end(),
                             [&](const CellHeight& height) { return height.z < heights[from].z + apart_m; }) -
        heights.begin());
  };
  for (std::size_t low = 0; low < heights.size(); ++low) {
    const std::size_t middle = next(low), high = middle < heights.size() ? next(middle) : middle;
    if (high < heights.size() && heights[high].z - heights[low].z <= within_m) return true;
  }
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

/// The points that lie in the grid, by cell, then by height.
std::vector<CellHeight> heights_by_cell(const std::vector<Eigen::Vector3f>& points_F, const CellGrid& grid) {
  std::vector<CellHeight> heights;
  for (const Eigen::Vector3f& p : points_F) {
    const double x = std::floor((p.x() - grid.min.x()) / grid.cell_m),
                 y = std::floor((p.y() - grid.min.y()) / grid.cell_m);
    if (!(x >= 0.0 && y >= 0.0 && x < grid.columns && y < grid.rows) || !std::isfinite(p.z())) continue;
    heights.push_back({static_cast<std::uint32_t>(grid.index(static_cast<int>(x), static_cast<int>(y))), p.z()});
  }
  std::sort(heights.begin(), heights.end());
  return heights;
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
  grid.cells.assign(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows), CellKind::empty);
  const std::vector<CellHeight> heights = heights_by_cell(points_F, grid);
  for (auto first = heights.begin(); first != heights.end();) {
    const auto end = std::find_if(first, heights.end(), [&](const CellHeight& h) { return h.cell != first->cell; });
    grid.cells[first->cell] = is_upright({first, end}) ? CellKind::upright : CellKind::level;
    first = end;
  }
  return grid;
}

/// Cells of one kind as level strokes, each as long as there are such cells beside each other.
std::string strokes(const CellGrid& grid, CellKind kind) {
  std::string d;
  for (int row = 0; row < grid.rows; ++row) {
    int start = -1;
    for (int column = 0; column <= grid.columns; ++column) {
      const bool is_kind = column < grid.columns && grid.at(column, row) == kind;
      if (is_kind && start < 0) start = column;
      if (is_kind || start < 0) continue;
      d += "M" + std::to_string(start) + " " + std::to_string(-row) + "h" + std::to_string(column - start);
      start = -1;
    }
  }
  return d;
}

std::string path_of(const CellGrid& grid, CellKind kind, const std::string& ink) {
  const std::string d = strokes(grid, kind);
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
         (over_plan ? path_of(grid, CellKind::upright, "stroke=\"" + method_ink(0) + "\" stroke-opacity=\".35\"")
                    : path_of(grid, CellKind::level, "stroke=\"var(--thing)\" stroke-opacity=\".5\"") +
                          path_of(grid, CellKind::upright, "stroke=\"var(--wall)\" stroke-opacity=\".6\"")) +
         "</g>";
}

}  // namespace plumbline::scenarios
