// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/solid_boxes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bim/errors.h"
#include "bim/mesh/solid.h"

namespace plumbline::sim {

namespace {

constexpr int direction_count = 36;  ///< of a bounding box: every 2.5 degrees of a quarter turn

using Polygon3 = std::vector<Eigen::Vector3d>;

/// The part of a polygon where sign * p[axis] <= sign * limit (Sutherland-Hodgman).
Polygon3 clip(const Polygon3& polygon, int axis, double limit, double sign) {
  Polygon3 out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d& p = polygon[i];
    const Eigen::Vector3d& q = polygon[(i + 1) % polygon.size()];
    const double dp = sign * (p[axis] - limit);
    const double dq = sign * (q[axis] - limit);
    if (dp <= 0.0) out.push_back(p);
    if ((dp < 0.0 && dq > 0.0) || (dp > 0.0 && dq < 0.0)) out.push_back(p + dp / (dp - dq) * (q - p));
  }
  return out;
}

Polygon3 clip_between(const Polygon3& polygon, int axis, double low, double high) {
  return clip(clip(polygon, axis, low, -1.0), axis, high, 1.0);
}

/// Rectangle of cells [x0, x1) x [y0, y1) and the heights found in them.
struct CellBlock {
  int x0 = 0, x1 = 0, y0 = 0, y1 = 0;
  HeightRange z;
};

class CellGrid {
 public:
  CellGrid(const Eigen::Vector2d& low, const Eigen::Vector2d& high, double cell)
      : low_(low), cell_(cell), nx_(count(high.x() - low.x())), ny_(count(high.y() - low.y())) {
    z_.assign(static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_), empty);
  }

  void add(const Polygon3& polygon) {
    Eigen::Vector3d low = polygon[0];
    Eigen::Vector3d high = polygon[0];
    for (const Eigen::Vector3d& p : polygon) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    for (int y = index(low.y(), 1); y <= index(high.y(), 1); ++y) {
      const Polygon3 row = clip_between(polygon, 1, edge(y, 1), edge(y + 1, 1));
      if (row.empty()) continue;
      for (int x = index(low.x(), 0); x <= index(high.x(), 0); ++x)
        for (const Eigen::Vector3d& p : clip_between(row, 0, edge(x, 0), edge(x + 1, 0))) include(x, y, p.z());
    }
  }

  /// Runs of occupied cells along x that begin at about one height, unlike the legs of a table and its top; a run that
  /// repeats in the next row joins it.
  [[nodiscard]] std::vector<CellBlock> blocks() const {
    std::vector<CellBlock> blocks;
    std::vector<std::size_t> before;  // blocks that reach into the row before
    for (int y = 0; y < ny_; ++y) {
      std::vector<std::size_t> now;
      for (int x = 0; x < nx_; ++x) {
        if (!occupied(x, y)) continue;
        CellBlock run{x, x + 1, y, y + 1, at(x, y)};
        for (; run.x1 < nx_ && occupied(run.x1, y) && begin_alike(at(run.x1 - 1, y), at(run.x1, y)); ++run.x1)
          widen(at(run.x1, y), run.z);
        now.push_back(join(run, before, blocks));
        x = run.x1 - 1;
      }
      before = std::move(now);
    }
    return blocks;
  }

  [[nodiscard]] CollisionBox box(const CellBlock& b) const {
    const Eigen::Vector2d low(edge(b.x0, 0), edge(b.y0, 1));
    const Eigen::Vector2d high(edge(b.x1, 0), edge(b.y1, 1));
    return upright_box(0.5 * (low + high), 0.0, 0.5 * (high - low), b.z);
  }

 private:
  static constexpr HeightRange empty{1.0, -1.0};

  [[nodiscard]] int count(double length) const { return std::max(1, static_cast<int>(std::ceil(length / cell_))); }
  [[nodiscard]] double edge(int i, int axis) const { return low_[axis] + i * cell_; }
  [[nodiscard]] int index(double v, int axis) const {
    return std::clamp(static_cast<int>((v - low_[axis]) / cell_), 0, (axis == 0 ? nx_ : ny_) - 1);
  }
  [[nodiscard]] std::size_t slot(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(nx_) + static_cast<std::size_t>(x);
  }
  [[nodiscard]] const HeightRange& at(int x, int y) const { return z_[slot(x, y)]; }
  [[nodiscard]] bool occupied(int x, int y) const { return at(x, y).from <= at(x, y).to; }

  void include(int x, int y, double z) {
    HeightRange& cell = z_[slot(x, y)];
    if (occupied(x, y))
      widen({z, z}, cell);
    else
      cell = {z, z};
  }

  static bool begin_alike(const HeightRange& a, const HeightRange& b) {
    constexpr double step_m = 0.3;  // less than between the floor and what is walked under
    return std::abs(a.from - b.from) <= step_m;
  }

  static void widen(const HeightRange& by, HeightRange& z) { z = {std::min(z.from, by.from), std::max(z.to, by.to)}; }

  /// Index of the block that the run has become part of.
  static std::size_t join(const CellBlock& run, const std::vector<std::size_t>& before,
                          std::vector<CellBlock>& blocks) {
    for (const std::size_t i : before) {
      CellBlock& b = blocks[i];
      if (b.x0 != run.x0 || b.x1 != run.x1 || !begin_alike(b.z, run.z)) continue;
      b.y1 = run.y1;
      widen(run.z, b.z);
      return i;
    }
    blocks.push_back(run);
    return blocks.size() - 1;
  }

  Eigen::Vector2d low_;
  double cell_;
  int nx_;
  int ny_;
  std::vector<HeightRange> z_;
};

/// Triangles of a solid, cut to the heights.
std::vector<Polygon3> surface_between(const bim::Solid& solid, const HeightRange& reach) {
  std::vector<Polygon3> out;
  for (const Eigen::Vector3i& t : solid.triangles) {
    Polygon3 triangle;
    for (int k = 0; k < 3; ++k) triangle.push_back(solid.vertices[static_cast<std::size_t>(t[k])]);
    Polygon3 part = clip_between(triangle, 2, reach.from, reach.to);
    if (!part.empty()) out.push_back(std::move(part));
  }
  return out;
}

/// Volume inside a closed surface that was cut at two heights, m^3: the flux of (x, 0, 0), to which the missing
/// horizontal faces would add nothing.
double enclosed_volume(const std::vector<Polygon3>& surface) {
  double sum = 0.0;
  for (const Polygon3& p : surface)
    for (std::size_t i = 1; i + 1 < p.size(); ++i) {
      const double area_x = 0.5 * (p[i] - p[0]).cross(p[i + 1] - p[0]).x();
      sum += area_x * (p[0].x() + p[i].x() + p[i + 1].x()) / 3.0;
    }
  return sum;
}

}  // namespace

CollisionBox upright_box(const Eigen::Vector2d& center, double yaw, const Eigen::Vector2d& half, const HeightRange& z) {
  CollisionBox box;
  box.X_WB = Pose::from_xyz_yaw({center.x(), center.y(), 0.5 * (z.from + z.to)}, yaw);
  box.half = {half.x(), half.y(), 0.5 * (z.to - z.from)};
  return box;
}

CollisionBox box_along(const std::vector<Eigen::Vector2d>& points, double yaw, const HeightRange& z) {
  const Eigen::Vector2d ex(std::cos(yaw), std::sin(yaw));
  const Eigen::Vector2d ey(-ex.y(), ex.x());
  Eigen::Vector2d low(ex.dot(points[0]), ey.dot(points[0]));
  Eigen::Vector2d high = low;
  for (const Eigen::Vector2d& p : points) {
    const Eigen::Vector2d local(ex.dot(p), ey.dot(p));
    low = low.cwiseMin(local);
    high = high.cwiseMax(local);
  }
  const Eigen::Vector2d mid = 0.5 * (low + high);
  return upright_box(mid.x() * ex + mid.y() * ey, yaw, 0.5 * (high - low), z);
}

CollisionBox bounding_box(const std::vector<Eigen::Vector2d>& points, const HeightRange& z) {
  CollisionBox best;
  double best_area = -1.0;
  for (int i = 0; i < direction_count; ++i) {
    const CollisionBox box = box_along(points, i * 0.5 * std::numbers::pi / direction_count, z);
    const double area = 4.0 * box.half.head<2>().prod();
    if (best_area >= 0.0 && area >= best_area - 1e-9) continue;
    best_area = area;
    best = box;
  }
  return best;
}

std::vector<CollisionBox> solid_boxes(const bim::Solid& solid, const HeightRange& reach,
                                      const Eigen::AlignedBox2d& area, const CollisionConfig& config) {
  const std::vector<Polygon3> surface = surface_between(solid, reach);
  if (surface.empty()) return {};
  std::vector<Eigen::Vector2d> points;
  HeightRange z{surface[0][0].z(), surface[0][0].z()};
  for (const Polygon3& polygon : surface)
    for (const Eigen::Vector3d& p : polygon) {
      points.emplace_back(p.head<2>());
      z = {std::min(z.from, p.z()), std::max(z.to, p.z())};
    }
  const CollisionBox whole = bounding_box(points, z);
  // An open surface encloses nothing, whatever its flux.
  const double fill = enclosed_volume(surface) / (8.0 * whole.half.prod());
  const bool passage = fill < config.full_fill && whole.half.head<2>().maxCoeff() > 0.5 * config.passage_m;
  if (fill >= config.box_fill && !passage && bim::is_closed(bim::welded(solid, config.weld_m))) return {whole};

  Eigen::Vector2d low = points[0];
  Eigen::Vector2d high = points[0];
  for (const Eigen::Vector2d& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const auto too_large = [&] { return ((high - low) / config.cell_m).prod() > config.cells_max; };
  if (too_large() && !area.isEmpty()) {
    low = low.cwiseMax(area.min());
    high = high.cwiseMin(area.max());
    if ((high - low).minCoeff() <= 0.0) return {};
  }
  if (too_large())
    throw InputError({},
                     "an obstacle within the robot's reach is larger than 200 m by 200 m, as is the floor around it; "
                     "leave it out or cut it");
  CellGrid grid(low, high, config.cell_m);
  for (const Polygon3& polygon : surface) grid.add(polygon);
  std::vector<CollisionBox> boxes;
  for (const CellBlock& block : grid.blocks()) boxes.push_back(grid.box(block));
  return boxes;
}

}  // namespace plumbline::sim
