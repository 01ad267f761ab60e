// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/mesh/mesh_ground.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "bim/geometry/polygon_boolean.h"

namespace plumbline::bim {
namespace {

/// Twice its area long.
Eigen::Vector3d normal_of(const TriangleCorners& c) { return (c[1] - c[0]).cross(c[2] - c[0]); }

struct Layer {
  double area = 0.0, moment = 0.0, low = INFINITY, high = -INFINITY;
};

/// Floor by height, in layers of equal thickness.
class Layers {
 public:
  explicit Layers(double layer_m) : layer_m_(layer_m) {}

  void add(const TriangleCorners& c, double area) {
    std::array<double, 3> z = {c[0].z(), c[1].z(), c[2].z()};
    std::sort(z.begin(), z.end());
    const long first = index(z[0]), last = index(z[2]);
    if (first == last) {
      put(first, area, mean_height(c), {z[0], z[2]});
      return;
    }
    double before = 0.0;
    for (long k = first; k <= last; ++k) {
      const double low = std::max(z[0], edge(k)), high = std::min(z[2], edge(k + 1));
      const double share = k == last ? 1.0 : share_below(z, high);
      put(k, area * (share - before), 0.5 * (low + high), {low, high});
      before = share;
    }
  }

  [[nodiscard]] const std::map<long, Layer>& all() const { return layers_; }
  /// Lower edge of a layer: half a layer off, so that heights near 0, the commonest, fall into one.
  [[nodiscard]] double edge(long k) const { return layer_m_ * (static_cast<double>(k) - 0.5); }

 private:
  [[nodiscard]] long index(double z) const { return std::lround(std::floor(z / layer_m_ + 0.5)); }

  /// Share of a triangle's area below a height, by the sorted heights of its corners.
  static double share_below(const std::array<double, 3>& z, double at) {
    if (at <= z[0]) return 0.0;
    if (at < z[1]) return (at - z[0]) * (at - z[0]) / ((z[1] - z[0]) * (z[2] - z[0]));
    if (at < z[2]) return 1.0 - (z[2] - at) * (z[2] - at) / ((z[2] - z[1]) * (z[2] - z[0]));
    return 1.0;
  }

  void put(long k, double area, double z, const std::pair<double, double>& range) {
    Layer& layer = layers_[k];
    layer.area += area;
    layer.moment += area * z;
    layer.low = std::min(layer.low, range.first);
    layer.high = std::max(layer.high, range.second);
  }

  double layer_m_;
  std::map<long, Layer> layers_;
};

/// Neighbouring layers without a gap.
struct Level {
  long first = 0, last = 0;
  Layer sum;
  double largest = 0.0;
};

std::vector<Level> levels_of(const std::map<long, Layer>& layers, double least_share) {
  double largest = 0.0;
  for (const auto& [k, layer] : layers) largest = std::max(largest, layer.area);
  std::vector<Level> levels;
  for (const auto& [k, layer] : layers) {
    if (!(layer.area > 0.0) || layer.area < least_share * largest) continue;
    if (levels.empty() || levels.back().last + 1 < k) levels.push_back({k, k, {}, 0.0});
    Level& level = levels.back();
    level.last = k;
    level.sum.area += layer.area;
    level.sum.moment += layer.moment;
    level.sum.low = std::min(level.sum.low, layer.low);
    level.sum.high = std::max(level.sum.high, layer.high);
    level.largest = std::max(level.largest, layer.area);
  }
  return levels;
}

/// Whether a level lies at few heights, with steps between them or not, rather than at all heights between two.
bool is_flat(const Level& level, const std::map<long, Layer>& thin_layers, const MeshGroundConfig& config) {
  double most = 0.0, before = 0.0;
  long last = 0;
  for (const auto& [k, layer] : thin_layers) {
    if (layer.high < level.sum.low || layer.low > level.sum.high) continue;
    most = std::max(most, layer.area + (k == last + 1 ? before : 0.0));
    before = layer.area;
    last = k;
  }
  return most >= config.flat_share * level.largest;
}

}  // namespace

double mean_height(const TriangleCorners& corners) { return (corners[0].z() + corners[1].z() + corners[2].z()) / 3.0; }

FloorFaces::FloorFaces(const std::vector<MeshPart>& parts, const MeshGroundConfig& config) : config_(config) {
  for_each_triangle(parts, [&](const TriangleCorners& c) {
    const Eigen::Vector3d normal = normal_of(c);
    if (const std::optional<Cell> cell = rough_cell(c, normal))
      normals_.try_emplace(*cell, Eigen::Vector3d::Zero()).first->second += normal;
  });
}

std::optional<FloorFaces::Cell> FloorFaces::rough_cell(const TriangleCorners& c, const Eigen::Vector3d& normal) const {
  const double longest = std::max({(c[1] - c[0]).norm(), (c[2] - c[1]).norm(), (c[0] - c[2]).norm()});
  if (longest > 0.5 * config_.rough_m || !(normal.z() > 0.0) || normal.z() < config_.rough_level * normal.norm())
    return std::nullopt;
  const Eigen::Vector3d middle = (c[0] + c[1] + c[2]) / (3.0 * config_.rough_m);
  return Cell{std::llround(middle.x()), std::llround(middle.y()), std::llround(middle.z())};
}

double FloorFaces::area(const TriangleCorners& corners) const {
  const Eigen::Vector3d normal = normal_of(corners);
  if (!(normal.z() > 0.0)) return 0.0;
  if (normal.z() >= config_.level * normal.norm()) return 0.5 * normal.z();
  const std::optional<Cell> cell = rough_cell(corners, normal);
  if (!cell) return 0.0;
  const Eigen::Vector3d& mean = normals_.at(*cell);
  return mean.z() >= config_.level * mean.norm() ? 0.5 * normal.z() : 0.0;
}

std::optional<MeshGround> find_ground(const std::vector<MeshPart>& parts, const FloorFaces& floor,
                                      const MeshGroundConfig& config) {
  Layers layers(config.layer_m), thin_layers(config.thin_m);
  for_each_triangle(parts, [&](const TriangleCorners& c) {
    const double area = floor.area(c);
    if (area <= 0.0) return;
    layers.add(c, area);
    thin_layers.add(c, area);
  });
  const std::vector<Level> levels = levels_of(layers.all(), config.least_share);
  double largest = 0.0;
  for (const Level& level : levels) largest = std::max(largest, level.sum.area);
  const auto found = std::find_if(levels.begin(), levels.end(),
                                  [&](const Level& level) { return level.sum.area >= config.ground_share * largest; });
  if (found == levels.end()) return std::nullopt;
  MeshGround ground;
  double below = 0.0;
  for (auto layer = layers.all().begin(); layer->first < found->first; ++layer) below += layer->second.area;
  ground.more_below = below >= config.ground_share * found->sum.area;
  ground.slopes = !is_flat(*found, thin_layers.all(), config);
  if (ground.slopes) {
    ground.z_m = snap(found->sum.moment / found->sum.area);
    ground.low_m = std::max(found->sum.low, ground.z_m - config.most_sunken_m);
    ground.high_m = found->sum.high;
    return ground;
  }
  const auto large = std::find_if(layers.all().lower_bound(found->first), layers.all().end(), [&](const auto& layer) {
    return layer.second.area >= config.ground_share * found->largest;
  });
  ground.z_m = snap(large->second.moment / large->second.area);
  ground.low_m = ground.z_m - config.layer_m;
  ground.high_m = ground.z_m + config.layer_m;
  return ground;
}

}  // namespace plumbline::bim
