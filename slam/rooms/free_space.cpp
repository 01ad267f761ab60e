// SPDX-License-Identifier: Apache-2.0
#include "slam/rooms/free_space.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumbline::slam {

namespace {

/// Visits the cells of a segment in order, sampled at half a cell; the cell of b is not visited.
template <class Visit>
void walk(const GridFrame& frame, const Eigen::Vector2d& a, const Eigen::Vector2d& b, Visit visit) {
  const double length = (b - a).norm();
  const int steps = std::max(1, static_cast<int>(std::ceil(2.0 * length / frame.cell)));
  const std::ptrdiff_t last = frame.find(b);
  std::ptrdiff_t previous = -1;
  for (int s = 0; s < steps; ++s) {
    const std::ptrdiff_t cell = frame.find(a + (b - a) * (static_cast<double>(s) / steps));
    if (cell < 0 || cell == previous || cell == last) continue;
    visit(static_cast<std::size_t>(cell));
    previous = cell;
  }
}

/// Turns components of non-free cells that touch no border and fit into a square of max_cells into free space.
void fill_islands(FreeGrid& grid, int max_cells) {
  const GridFrame& f = grid.frame;
  std::vector<std::uint8_t> seen(f.size(), 0);
  std::vector<std::size_t> component;
  for (std::size_t start = 0; start < f.size(); ++start) {
    if (grid.free[start] != 0 || seen[start] != 0) continue;
    component.assign(1, start);
    seen[start] = 1;
    bool inside = true;
    Eigen::Array2i low(f.nx, f.ny), high(0, 0);
    for (std::size_t k = 0; k < component.size(); ++k) {
      const int i = static_cast<int>(component[k] % static_cast<std::size_t>(f.nx));
      const int j = static_cast<int>(component[k] / static_cast<std::size_t>(f.nx));
      low = low.min(Eigen::Array2i(i, j));
      high = high.max(Eigen::Array2i(i, j));
      if (i == 0 || j == 0 || i + 1 == f.nx || j + 1 == f.ny) {
        inside = false;
        continue;
      }
      for (const std::size_t n : {f.index(i - 1, j), f.index(i + 1, j), f.index(i, j - 1), f.index(i, j + 1)}) {
        if (grid.free[n] != 0 || seen[n] != 0) continue;
        seen[n] = 1;
        component.push_back(n);
      }
    }
    if (inside && (high - low).maxCoeff() < max_cells)
      for (const std::size_t c : component) grid.free[c] = 1;
  }
}

}  // namespace

FreeRays free_rays(const DeskewedScan& scan, const Eigen::Vector3d& up_R, const FreeSpaceConfig& config) {
  FreeRays rays;
  rays.origin_R = scan.X_RL.t;
  std::vector<double> range(static_cast<std::size_t>(config.azimuths), 0.0);
  std::vector<Eigen::Vector3d> end(range.size());
  for (std::size_t k = 0; k < scan.point_R.size(); ++k) {
    if (scan.range_m[k] <= 0.0) continue;
    const Eigen::Vector3d ray = scan.point_R[k] - rays.origin_R;
    const double height = config.sensor_height_m + up_R.dot(ray);
    if (height < config.height_low_m || height > config.height_high_m) continue;
    const double horizontal = (ray - up_R * up_R.dot(ray)).norm();
    const double turn = (std::atan2(ray.y(), ray.x()) / (2.0 * std::numbers::pi)) + 0.5;
    const auto bin = std::min(static_cast<std::size_t>(turn * config.azimuths), range.size() - 1);
    if (horizontal <= range[bin]) continue;
    range[bin] = horizontal;
    end[bin] = scan.point_R[k];
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

Eigen::Vector2d GridFrame::center(std::size_t index) const {
  const auto i = static_cast<double>(index % static_cast<std::size_t>(nx));
  const auto j = static_cast<double>(index / static_cast<std::size_t>(nx));
  return origin_M + cell * Eigen::Vector2d(i + 0.5, j + 0.5);
}

std::ptrdiff_t GridFrame::find(const Eigen::Vector2d& p_M) const {
  const double x = std::floor((p_M.x() - origin_M.x()) / cell);
  const double y = std::floor((p_M.y() - origin_M.y()) / cell);
  if (x < 0.0 || y < 0.0 || x >= nx || y >= ny) return -1;
  return static_cast<std::ptrdiff_t>(index(static_cast<int>(x), static_cast<int>(y)));
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
  grow(low, high);
  for (std::size_t k = 0; k < ends.size(); ++k) {
    walk(frame_, origin, ends[k], [&](std::size_t cell) { ++passed_[cell]; });
    if (rays.hit[k]) ++ended_[static_cast<std::size_t>(frame_.find(ends[k]))];
  }
}

void FreeSpaceMap::clear() {
  frame_ = {.cell = config_.cell_m};
  passed_.clear();
  ended_.clear();
}

FreeGrid FreeSpaceMap::grid() const {
  FreeGrid grid{frame_, std::vector<std::uint8_t>(frame_.size(), 0)};
  for (std::size_t k = 0; k < grid.free.size(); ++k) grid.free[k] = passed_[k] > 0 && passed_[k] >= 2 * ended_[k];
  fill_islands(grid, static_cast<int>(std::lround(config_.island_m / frame_.cell)));
  return grid;
}

void FreeSpaceMap::grow(const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
  // Grown in blocks, so that a walk does not copy the grid at every keyframe; cells stay aligned to M's origin.
  constexpr double block_cells = 32.0;
  const double block = block_cells * frame_.cell;
  const auto down = [&](double v) { return block * std::floor((v - frame_.cell) / block); };
  const auto up = [&](double v) { return block * std::ceil((v + frame_.cell) / block); };
  Eigen::Vector2d new_low(down(low.x()), down(low.y())), new_high(up(high.x()), up(high.y()));
  if (frame_.nx > 0) {
    new_low = new_low.cwiseMin(frame_.origin_M);
    new_high = new_high.cwiseMax(frame_.origin_M + frame_.cell * Eigen::Vector2d(frame_.nx, frame_.ny));
  }
  GridFrame grown = frame_;
  grown.origin_M = new_low;
  grown.nx = static_cast<int>(std::lround((new_high.x() - new_low.x()) / frame_.cell));
  grown.ny = static_cast<int>(std::lround((new_high.y() - new_low.y()) / frame_.cell));
  if (grown.nx == frame_.nx && grown.ny == frame_.ny) return;
  std::vector<std::uint32_t> passed(grown.size(), 0), ended(grown.size(), 0);
  const int di = static_cast<int>(std::lround((frame_.origin_M.x() - new_low.x()) / frame_.cell));
  const int dj = static_cast<int>(std::lround((frame_.origin_M.y() - new_low.y()) / frame_.cell));
  for (int j = 0; j < frame_.ny; ++j)
    for (int i = 0; i < frame_.nx; ++i) {
      passed[grown.index(i + di, j + dj)] = passed_[frame_.index(i, j)];
      ended[grown.index(i + di, j + dj)] = ended_[frame_.index(i, j)];
    }
  frame_ = grown;
  passed_ = std::move(passed);
  ended_ = std::move(ended);
}

}  // namespace plumbline::slam
