// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/mesh/mesh_world.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include <utility>

#include "bim/config/tree.h"
#include "bim/errors.h"
#include "bim/geometry/polygon_boolean.h"
#include "bim/mesh/solid.h"

namespace plumbline::bim {

namespace {

using Corners = std::array<Eigen::Vector3d, 3>;

template <class Visit>
void for_each_triangle(const std::vector<MeshPart>& parts, Visit&& visit) {
  for (const MeshPart& part : parts)
    for (const Eigen::Vector3i& t : part.solid.triangles) {
      const auto& v = part.solid.vertices;
      visit(Corners{v[static_cast<std::size_t>(t[0])], v[static_cast<std::size_t>(t[1])],
                    v[static_cast<std::size_t>(t[2])]});
    }
}

/// Area of a triangle that faces up, m^2; 0 of any other.
double floor_area(const Corners& c, double level) {
  const Eigen::Vector3d normal = (c[1] - c[0]).cross(c[2] - c[0]);
  const double twice = normal.norm();
  return twice > 0.0 && normal.z() >= level * twice ? 0.5 * twice : 0.0;
}

double height(const Corners& c) { return (c[0].z() + c[1].z() + c[2].z()) / 3.0; }

/// Height of the lowest large floor: the mean of its layer, weighted by area.
double ground_height(const std::vector<MeshPart>& parts, const std::string& path, const MeshWorldConfig& config) {
  struct Layer {
    double area = 0.0, moment = 0.0;
  };
  std::map<long, Layer> layers;
  for_each_triangle(parts, [&](const Corners& c) {
    const double area = floor_area(c, config.level);
    if (area <= 0.0) return;
    // Half a layer off, so that heights near 0, the commonest, fall into one.
    Layer& layer = layers[std::lround(std::floor(height(c) / config.layer_m + 0.5))];
    layer.area += area;
    layer.moment += area * height(c);
  });
  double largest = 0.0;
  for (const auto& [index, layer] : layers) largest = std::max(largest, layer.area);
  for (const auto& [index, layer] : layers)
    if (layer.area > 0.0 && layer.area >= config.ground_share * largest) return snap(layer.moment / layer.area);
  throw InputError({path, 0, 0},
                   "nothing in it faces up, so there is no floor; is z up, and do its faces turn outwards?");
}

/// Cells of a grid whose centres lie over floor, as rectangles joined to outlines.
class FloorGrid {
 public:
  FloorGrid(const Eigen::AlignedBox3d& box, double cell) : origin_(box.min().head<2>()), cell_(cell) {
    const Eigen::Vector2d size = box.sizes().head<2>();
    nx_ = 1 + static_cast<int>(size.x() / cell);
    ny_ = 1 + static_cast<int>(size.y() / cell);
    covered_.assign(static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_), 0);
  }

  void add(const Corners& c) {
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
        if (centre >= low && centre <= high) covered_[slot(x, y)] = 1;
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

/// The floor's outline in cells, doubled until it is made of few enough rectangles.
Region2 floor_region(const std::vector<MeshPart>& parts, const Eigen::AlignedBox3d& box, double floor_z,
                     const MeshWorldConfig& config) {
  for (double cell = config.cell_m;; cell *= 2.0) {
    FloorGrid grid(box, cell);
    for_each_triangle(parts, [&](const Corners& c) {
      if (floor_area(c, config.level) > 0.0 && std::abs(height(c) - floor_z) <= config.layer_m) grid.add(c);
    });
    const std::vector<Polygon2> rectangles = grid.rectangles();
    if (rectangles.size() <= config.most_runs) return unite(rectangles);
  }
}

void add_slabs(const std::vector<MeshPart>& parts, const Eigen::AlignedBox3d& box, const MeshWorldConfig& config,
               Building& building) {
  const double floor_z = building.storeys.front().elevation_m;
  int number = 0;
  for (const PolygonWithHoles2& piece : floor_region(parts, box, floor_z, config)) {
    Slab slab;
    slab.id = "floor/" + std::to_string(++number);
    slab.storey = 0;
    slab.polygon = piece;
    slab.z1_m = floor_z - config.under_m;
    slab.z0_m = slab.z1_m - config.slab_m;
    building.slabs.push_back(std::move(slab));
  }
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
  const double floor_z = ground_height(parts, path, config);
  const double above = box.max().z() - floor_z;
  building.storeys.push_back({"ground", "ground", floor_z, above > 0.0 ? above : config.height_m});
  add_slabs(parts, box, config, building);
  for (MeshPart& part : parts)
    if (!part.solid.triangles.empty())
      building.obstacles.push_back({std::move(part.name), "mesh", 0, std::move(part.solid)});
  building.warnings.push_back({"", "no_plan", "a mesh without rooms and walls; localization is not possible in it"});
  std::move(assumed.begin(), assumed.end(), std::back_inserter(building.warnings));
  return building;
}

}  // namespace plumbline::bim
