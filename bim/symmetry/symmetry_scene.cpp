// SPDX-License-Identifier: Apache-2.0
#include "bim/symmetry/symmetry_scene.h"

#include <algorithm>
#include <cmath>

namespace plumbline::bim {

namespace {

std::vector<Eigen::AlignedBox2d> boxes_of(const std::vector<BodyPrism>& prisms) {
  std::vector<Eigen::AlignedBox2d> boxes(prisms.size());
  for (std::size_t i = 0; i < prisms.size(); ++i)
    for (const Eigen::Vector2d& p : prisms[i].outline) boxes[i].extend(p);
  return boxes;
}

/// Extent of an element in plan, along and across its first surface.
struct Extent {
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();
  Eigen::AlignedBox2d box;

  void add(const Eigen::Vector2d& p) {
    box.extend(Eigen::Vector2d(along.dot(p), along.x() * p.y() - along.y() * p.x()));
  }
};

std::vector<double> sizes_of(const std::vector<SurfaceRect>& rects, std::size_t elements) {
  std::vector<Extent> extents(elements);
  for (const SurfaceRect& rect : rects) {
    Extent& extent = extents[static_cast<std::size_t>(rect.element)];
    if (extent.box.isEmpty()) extent.along = rect.direction();
    extent.add(rect.p);
    extent.add(rect.q);
  }
  std::vector<double> sizes(elements, 0.0);
  for (std::size_t i = 0; i < elements; ++i)
    if (!extents[i].box.isEmpty()) sizes[i] = extents[i].box.sizes().maxCoeff();
  return sizes;
}

/// Distance of each sample of one set of surfaces to another set, kept as the largest of each element.
class Measure {
 public:
  Measure(const SymmetryScene& scene, const SymmetryConfig& config) : scene_(scene), config_(config) {
    for (const SurfaceRect& rect : scene.surfaces().rects())
      largest_.resize(std::max(largest_.size(), static_cast<std::size_t>(rect.element) + 1));
  }

  /// Measures every surface, taken through g, against `target`.
  void against(const SurfaceIndex& target, const Isometry2& g) {
    for (const SurfaceRect& rect : scene_.surfaces().rects()) {
      const SurfaceRect image = moved(g, rect);
      if (!covered(target, image)) sample(target, image, rect, g);
    }
  }

  /// Appends what deviates by more than exact_m.
  void report(std::vector<Deviation>& deviations) const {
    for (std::size_t i = 0; i < largest_.size(); ++i)
      if (largest_[i].size_m > config_.exact_m) {
        deviations.push_back(largest_[i]);
        deviations.back().element = scene_.element_id(static_cast<int>(i));
      }
  }
  [[nodiscard]] double largest() const {
    double value = 0.0;
    for (const Deviation& deviation : largest_) value = std::max(value, deviation.size_m);
    return value;
  }

 private:
  /// All four corners lie on one surface of the target, so that the whole rectangle does.
  [[nodiscard]] bool covered(const SurfaceIndex& target, const SurfaceRect& image) const {
    int rect = -1;
    const double reach = 0.5 * config_.exact_m;
    for (const Eigen::Vector2d& p : {image.p, image.q}) {
      for (const double z : {image.z0, image.z1}) {
        const auto found = target.nearest({p.x(), p.y(), z}, image.direction(), reach);
        if (!found || (rect >= 0 && found->rect != rect)) return false;
        rect = found->rect;
      }
    }
    return target.rects()[static_cast<std::size_t>(rect)].direction().dot(image.direction()) > 0.5;
  }

  void sample(const SurfaceIndex& target, const SurfaceRect& image, const SurfaceRect& rect, const Isometry2& g) {
    const int along = std::max(2, static_cast<int>(std::ceil(image.length() / config_.sample_m)));
    const int up = std::max(2, static_cast<int>(std::ceil((image.z1 - image.z0) / config_.sample_up_m)));
    const auto element = static_cast<std::size_t>(rect.element);
    Deviation& largest = largest_[element];
    const double size = std::min(config_.reach_m, scene_.size_m(rect.element));
    for (int i = 0; i <= along; ++i) {
      const Eigen::Vector2d p = image.p + (image.q - image.p) * i / along;
      for (int k = 0; k <= up; ++k) {
        const double z = image.z0 + (image.z1 - image.z0) * k / up;
        const auto found = target.nearest({p.x(), p.y(), z}, image.direction(), size);
        const double d = found ? found->distance_m : size;
        // Of equal ones the first: by surface, then along, then up.
        if (d > largest.size_m) largest = {{}, g.inverse() * p, d};
      }
    }
  }

  const SymmetryScene& scene_;
  const SymmetryConfig& config_;
  std::vector<Deviation> largest_;
};

SimilarityGrade grade_of(double iou, double deviation_m, const SymmetryConfig& config) {
  // Thin walls have little in common long before a beam tells them apart.
  const double least = deviation_m <= config.match_m ? std::min(config.iou_min, config.iou_thin_min) : config.iou_min;
  if (iou < least || deviation_m > config.near_m + config.sliver_m) return SimilarityGrade::different;
  return deviation_m <= config.exact_m ? SimilarityGrade::exact : SimilarityGrade::near;
}

/// A few surfaces spread over the storey are enough to see that most have no counterpart.
bool hopeless(const SymmetryScene& from, const SymmetryScene& to, const Isometry2& g, const SymmetryConfig& config) {
  constexpr std::size_t looks = 97;
  constexpr double share_of_misses = 0.3;
  const std::vector<SurfaceRect>& rects = from.surfaces().rects();
  const std::size_t step = std::max<std::size_t>(1, rects.size() / looks);
  int count = 0, misses = 0;
  for (std::size_t i = 0; i < rects.size(); i += step) {
    const SurfaceRect image = moved(g, rects[i]);
    const Eigen::Vector2d middle = 0.5 * (image.p + image.q);
    const Eigen::Vector3d p(middle.x(), middle.y(), 0.5 * (image.z0 + image.z1));
    ++count;
    if (!to.surfaces().nearest(p, image.direction(), config.near_m)) ++misses;
  }
  return misses > share_of_misses * count;
}

/// Edges of openings in the storey's floors, where they lie in a room. They follow the bodies' elements.
void add_floor_edges(const Building& building, SymmetryBodies& bodies, std::vector<SurfaceRect>& rects) {
  constexpr double inside_m = 0.01;
  const double floor = building.storeys[static_cast<std::size_t>(bodies.storey)].elevation_m;
  const auto in_room = [&](const Eigen::Vector2d& p) {
    return std::any_of(building.rooms.begin(), building.rooms.end(),
                       [&](const Room& room) { return room.storey == bodies.storey && room.contains(p); });
  };
  for (const Slab& slab : building.slabs) {
    bodies.elements.push_back(slab.id);
    if (slab.storey != bodies.storey || slab.z1_m > floor + inside_m) continue;
    for (const Polygon2& hole : slab.polygon.holes) {
      for (std::size_t k = 0; k < hole.size(); ++k) {
        const Eigen::Vector2d &p = hole[k], &q = hole[(k + 1) % hole.size()];
        if (in_room(0.5 * (p + q)))
          rects.push_back({p, q, slab.z0_m - floor, slab.z1_m - floor, static_cast<int>(bodies.elements.size()) - 1});
      }
    }
  }
}

std::vector<SurfaceRect> surfaces_of(const Building& building, SymmetryBodies& bodies, const SymmetryConfig& config) {
  std::vector<SurfaceRect> rects = visible_surfaces(bodies.prisms, config.touch_m, {config.sliver_m, config.exact_m});
  add_floor_edges(building, bodies, rects);
  return rects;
}

}  // namespace

SymmetryScene::SymmetryScene(const Building& building, int storey, const SymmetryConfig& config)
    : bodies_(symmetry_bodies(building, storey)),
      disjoint_(without_overlaps(bodies_.prisms)),
      grid_(boxes_of(disjoint_)),
      surfaces_(surfaces_of(building, bodies_, config)),
      sizes_m_(sizes_of(surfaces_.rects(), bodies_.elements.size())),
      volume_(volume(disjoint_)) {
  for (const BodyPrism& prism : disjoint_)
    centroid_ += signed_area(prism.outline) * (prism.z1 - prism.z0) * plumbline::centroid(prism.outline);
  if (volume_ > 0.0) centroid_ /= volume_;
}

double SymmetryScene::shared_volume(const SymmetryScene& other, const Isometry2& g) const {
  double sum = 0.0;
  std::vector<int> near;
  for (const BodyPrism& prism : other.disjoint_) {
    const Polygon2 image = g * prism.outline;
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& p : image) box.extend(p);
    grid_.near(box, near);
    for (const int i : near) {
      const BodyPrism& here = disjoint_[static_cast<std::size_t>(i)];
      const double height = std::min(here.z1, prism.z1) - std::max(here.z0, prism.z0);
      if (height <= 0.0) continue;
      const Polygon2 common = convex_intersection(image, here.outline);
      if (common.size() >= 3) sum += height * signed_area(common);
    }
  }
  return sum;
}

Similarity compare(const SymmetryScene& from, const SymmetryScene& to, const Isometry2& g,
                   const SymmetryConfig& config) {
  Similarity similarity;
  if (hopeless(from, to, g, config)) return similarity;
  const double shared = to.shared_volume(from, g);
  const double both = from.volume_m3() + to.volume_m3() - shared;
  similarity.iou = both > 0.0 ? std::min(1.0, shared / both) : 0.0;
  if (similarity.iou < std::min(config.iou_min, config.iou_thin_min)) return similarity;
  Measure there(from, config), back(to, config);
  there.against(to.surfaces(), g);
  back.against(from.surfaces(), g.inverse());
  similarity.deviation_m = std::max(there.largest(), back.largest());
  there.report(similarity.deviations);
  if (from.storey() != to.storey() || similarity.deviations.empty()) back.report(similarity.deviations);
  std::stable_sort(similarity.deviations.begin(), similarity.deviations.end(),
                   [](const Deviation& a, const Deviation& b) { return a.size_m > b.size_m; });
  if (static_cast<int>(similarity.deviations.size()) > config.deviations_max)
    similarity.deviations.resize(static_cast<std::size_t>(config.deviations_max));
  similarity.grade = grade_of(similarity.iou, similarity.deviation_m, config);
  return similarity;
}

}  // namespace plumbline::bim
