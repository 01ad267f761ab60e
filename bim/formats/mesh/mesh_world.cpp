// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/mesh/mesh_world.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include "bim/config/tree.h"
#include "bim/errors.h"
#include "bim/geometry/polygon_boolean.h"
#include "bim/mesh/solid.h"

namespace plumbline::bim {

namespace {

/// Cells of a grid whose centres lie over floor, as rectangles joined to outlines.
class FloorGrid {
 public:
  FloorGrid(const Eigen::AlignedBox3d& box, double cell) : origin_(box.min().head<2>()), cell_(cell) {
    const Eigen::Vector2d size = box.sizes().head<2>();
    nx_ = 1 + static_cast<int>(size.x() / cell);
    ny_ = 1 + static_cast<int>(size.y() / cell);
    covered_.assign(static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_), 0);
  }

  /// Where the triangle lies between two heights.
  void add(const TriangleCorners& c, double low_z, double high_z) {
    const Eigen::Vector3d normal = (c[1] - c[0]).cross(c[2] - c[0]);
    const auto is_between = [&](double x, double y) {
      const double z = c[0].z() - (normal.x() * (x - c[0].x()) + normal.y() * (y - c[0].y())) / normal.z();
      return z >= low_z && z <= high_z;
    };
    const auto [low_y, high_y] = std::minmax({c[0].y(), c[1].y(), c[2].y()});
    for (int y = index(low_y, 1); y <= index(high_y, 1); ++y) {
      double low = INFINITY, high = -INFINITY;
      const double at = origin_.y() + (y + 0.5) * cell_;
      for (std::size_t k = 0; k < 3; ++k) {
        const Eigen::Vector3d &a = c[k], &b = c[(k + 1) % 3];
        if ((a.y() > at) == (b.y() > at)) continue;
        const double x = a.x() + (b.x() - a.x()) * ((at - a.y()) / (b.y() - a.y()));
        low = std::min(low, x);
        high = std::max(high, x);
      }
      if (!(low <= high)) continue;
      for (int x = index(low, 0); x <= index(high, 0); ++x) {
        const double centre = origin_.x() + (x + 0.5) * cell_;
        if (centre >= low && centre <= high && is_between(centre, at)) covered_[slot(x, y)] = 1;
      }
    }
  }

  [[nodiscard]] std::vector<Polygon2> rectangles() const {
    std::vector<Polygon2> found;
    std::map<std::pair<int, int>, int> open;  // runs of the row before and where their rectangle began
    for (int y = 0; y <= ny_; ++y) {
      std::map<std::pair<int, int>, int> now;
      for (const auto& run : y < ny_ ? runs(y) : std::vector<std::pair<int, int>>{}) {
        const auto before = open.find(run);
        now[run] = before == open.end() ? y : before->second;
      }
      for (const auto& [run, begin] : open)
        if (!now.contains(run)) found.push_back(rectangle(run, begin, y));
      open = std::move(now);
    }
    return found;
  }

 private:
  [[nodiscard]] int index(double v, int axis) const {
    return std::clamp(static_cast<int>((v - origin_[axis]) / cell_), 0, (axis == 0 ? nx_ : ny_) - 1);
  }
  [[nodiscard]] std::size_t slot(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(nx_) + static_cast<std::size_t>(x);
  }
  [[nodiscard]] std::vector<std::pair<int, int>> runs(int y) const {
    std::vector<std::pair<int, int>> found;
    for (int x = 0; x < nx_; ++x) {
      if (covered_[slot(x, y)] == 0) continue;
      const int begin = x;
      while (x < nx_ && covered_[slot(x, y)] != 0) ++x;
      found.emplace_back(begin, x);
    }
    return found;
  }
  [[nodiscard]] Polygon2 rectangle(const std::pair<int, int>& run, int y0, int y1) const {
    const auto at = [&](int x, int y) -> Eigen::Vector2d { return origin_ + cell_ * Eigen::Vector2d(x, y); };
    return {at(run.first, y0), at(run.second, y0), at(run.second, y1), at(run.first, y1)};
  }

  Eigen::Vector2d origin_;
  double cell_;
  int nx_ = 0, ny_ = 0;
  std::vector<char> covered_;
};

bool is_ground(const TriangleCorners& c, const FloorFaces& floor, const MeshGround& ground) {
  if (floor.area(c) <= 0.0) return false;
  if (ground.slopes) return true;  // parts of it may be
  const double z = mean_height(c);
  return z >= ground.low_m && z <= ground.high_m;
}

/// The floor's outline in cells, doubled until it is made of few enough rectangles.
Region2 floor_region(const std::vector<MeshPart>& parts, const Eigen::AlignedBox3d& box, const FloorFaces& floor,
                     const MeshGround& ground, const MeshWorldConfig& config) {
  constexpr double rounding_m = 1e-6;
  const double low_z = ground.slopes ? ground.low_m - rounding_m : -INFINITY;
  const double high_z = ground.slopes ? ground.high_m + rounding_m : INFINITY;
  for (double cell = config.cell_m;; cell *= 2.0) {
    FloorGrid grid(box, cell);
    for_each_triangle(parts, [&](const TriangleCorners& c) {
      if (is_ground(c, floor, ground)) grid.add(c, low_z, high_z);
    });
    const std::vector<Polygon2> rectangles = grid.rectangles();
    if (rectangles.size() <= config.most_runs) return unite(rectangles);
  }
}

/// No point of the ground lies lower.
double lowest_of(const std::vector<MeshPart>& parts, const FloorFaces& floor, const MeshGround& ground) {
  if (ground.slopes) return ground.low_m;
  double lowest = ground.z_m;
  for_each_triangle(parts, [&](const TriangleCorners& c) {
    if (is_ground(c, floor, ground)) lowest = std::min({lowest, c[0].z(), c[1].z(), c[2].z()});
  });
  return lowest;
}

void add_slabs(const std::vector<MeshPart>& parts, const Eigen::AlignedBox3d& box, const FloorFaces& floor,
               const MeshGround& ground, const MeshWorldConfig& config, Building& building) {
  const double lowest = lowest_of(parts, floor, ground);
  int number = 0;
  for (const PolygonWithHoles2& piece : floor_region(parts, box, floor, ground, config)) {
    Slab slab;
    slab.id = "floor/" + std::to_string(++number);
    slab.storey = 0;
    slab.polygon = piece;
    slab.z1_m = lowest - config.under_m;
    slab.z0_m = slab.z1_m - config.slab_m;
    building.slabs.push_back(std::move(slab));
  }
}

void warn_of_ground(const MeshGround& ground, Building& building) {
  const auto height = [](double z) { return format_number(std::round(100.0 * z) / 100.0) + " m"; };
  if (ground.slopes)
    building.warnings.push_back({"", "assumed_ground",
                                 "its floor is not level, from " + height(ground.low_m) + " up to " +
                                     height(ground.high_m) + "; the ground is taken as level at " + height(ground.z_m) +
                                     ", their mean"});
  if (ground.more_below)
    building.warnings.push_back(
        {"", "assumed_ground",
         "the ground is taken at " + height(ground.z_m) + ", though as much of the mesh faces up below it"});
}

}  // namespace

Building read_mesh_world(std::string_view bytes, const std::string& path, const MeshWorldConfig& config) {
  std::vector<MeshPart> parts = read_mesh_parts(bytes, path, config.file);
  std::vector<Warning> assumed = settle_axes(parts, path, config.axes);
  for (MeshPart& part : parts) part.solid = welded(part.solid, config.weld_m);
  const Eigen::AlignedBox3d box = box_of(parts);

  Building building;
  building.name = std::filesystem::path(path).stem().string();
  building.schema = "mesh";
  building.unit = "m";
  const FloorFaces floor(parts, config.ground);
  const std::optional<MeshGround> ground = find_ground(parts, floor, config.ground);
  if (!ground)
    throw InputError({path, 0, 0},
                     "nothing in it faces up, so there is no floor; is z up, and do its faces turn outwards?");
  const double above = box.max().z() - ground->z_m;
  building.storeys.push_back({"ground", "ground", ground->z_m, above > 0.0 ? above : config.height_m});
  add_slabs(parts, box, floor, *ground, config, building);
  for (MeshPart& part : parts)
    if (!part.solid.triangles.empty())
      building.obstacles.push_back({std::move(part.name), "mesh", 0, std::move(part.solid)});
  building.warnings.push_back({"", "no_plan", "a mesh without rooms and walls; localization is not possible in it"});
  std::move(assumed.begin(), assumed.end(), std::back_inserter(building.warnings));
  warn_of_ground(*ground, building);
  return building;
}

}  // namespace plumbline::bim
