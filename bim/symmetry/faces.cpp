// SPDX-License-Identifier: Apache-2.0
#include "bim/symmetry/faces.h"

#include <algorithm>
#include <cmath>

#include "bim/model/boxes.h"

namespace plumbline::bim {

namespace {

/// Part of one surface, s along it from p.
struct Patch {
  double s0 = 0.0, s1 = 0.0, z0 = 0.0, z1 = 0.0;
};

std::vector<Eigen::AlignedBox2d> boxes_of(const std::vector<SurfaceRect>& rects) {
  std::vector<Eigen::AlignedBox2d> boxes;
  boxes.reserve(rects.size());
  for (const SurfaceRect& rect : rects)
    boxes.emplace_back(Eigen::Vector2d(rect.p.cwiseMin(rect.q)), Eigen::Vector2d(rect.p.cwiseMax(rect.q)));
  return boxes;
}

/// Stretch of the line p + s e.
struct Stretch {
  double s0 = 0.0, s1 = 0.0;

  /// Keeps what lies at most reach_m on the outer side of the line through `on` with unit normal n.
  void clip(double height, double slope, double reach_m) {
    constexpr double parallel = 1e-9;
    if (slope > parallel)
      s1 = std::min(s1, (reach_m - height) / slope);
    else if (slope < -parallel)
      s0 = std::max(s0, (reach_m - height) / slope);
    else if (height > reach_m)
      s1 = s0;
  }
};

Eigen::Vector2d outward(const Polygon2& outline, std::size_t k) {
  const Eigen::Vector2d edge = (outline[(k + 1) % outline.size()] - outline[k]).normalized();
  return {edge.y(), -edge.x()};
}

/// The stretch of p + s e, 0 <= s <= length, inside a convex outline grown by touch_m all round. A surface that lies
/// flush on the outline and has the same normal is covered only where `yields`.
std::optional<Stretch> covered(const Eigen::Vector2d& p, const Eigen::Vector2d& e, double length,
                               const Polygon2& outline, double touch_m, bool yields) {
  constexpr double same_way = 1.0 - 1e-6;
  constexpr double flush_m = 1e-4;
  const Eigen::Vector2d facing(e.y(), -e.x());
  double reach_m = touch_m;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Eigen::Vector2d n = outward(outline, k);
    const double height = n.dot(p - outline[k]);
    if (n.dot(facing) <= same_way || height <= -flush_m) continue;
    if (height > flush_m || !yields) return std::nullopt;
    reach_m = 0.0;  // the two go on from each other without a gap
  }
  Stretch stretch{0.0, length};
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Eigen::Vector2d n = outward(outline, k);
    const double height = n.dot(p - outline[k]);
    stretch.clip(height, n.dot(e), n.dot(facing) > same_way ? touch_m : reach_m);
    // Past a sharp corner the grown sides would meet far out.
    const Eigen::Vector2d bevel = (n + outward(outline, (k + 1) % outline.size())).normalized();
    const Eigen::Vector2d& corner = outline[(k + 1) % outline.size()];
    stretch.clip(bevel.dot(p - corner), bevel.dot(e), touch_m);
  }
  if (stretch.s1 <= stretch.s0) return std::nullopt;
  return stretch;
}

void subtract_patch(const Patch& taken, const Slivers& slivers, std::vector<Patch>& patches) {
  std::vector<Patch> left;
  const auto keep = [&](double s0, double s1, double z0, double z1) {
    if (s1 - s0 > slivers.along_m && z1 - z0 > slivers.up_m) left.push_back({s0, s1, z0, z1});
  };
  for (const Patch& patch : patches) {
    const double s0 = std::max(patch.s0, taken.s0), s1 = std::min(patch.s1, taken.s1);
    const double z0 = std::max(patch.z0, taken.z0), z1 = std::min(patch.z1, taken.z1);
    if (s1 <= s0 || z1 <= z0) {
      left.push_back(patch);
      continue;
    }
    keep(patch.s0, s0, patch.z0, patch.z1);
    keep(s1, patch.s1, patch.z0, patch.z1);
    keep(s0, s1, patch.z0, z0);
    keep(s0, s1, z1, patch.z1);
  }
  patches = std::move(left);
}

/// Distance in the plane and in height to an upright rectangle.
double distance(const SurfaceRect& rect, const Eigen::Vector3d& p) {
  const double across = segment_distance(rect.p, rect.q, p.head<2>());
  const double up = std::max({0.0, rect.z0 - p.z(), p.z() - rect.z1});
  return std::hypot(across, up);
}

}  // namespace

SurfaceRect moved(const Isometry2& g, const SurfaceRect& rect) {
  SurfaceRect image = rect;
  image.p = g * (g.mirrored ? rect.q : rect.p);
  image.q = g * (g.mirrored ? rect.p : rect.q);
  return image;
}

std::vector<SurfaceRect> visible_surfaces(const std::vector<BodyPrism>& prisms, double touch_m,
                                          const Slivers& slivers) {
  std::vector<Eigen::AlignedBox2d> boxes;
  for (const BodyPrism& prism : prisms) boxes.push_back(box_of(prism.outline));
  const BodyGrid grid(boxes);
  constexpr double joint_m = 1e-4;
  std::vector<SurfaceRect> result;
  std::vector<int> near;
  for (std::size_t i = 0; i < prisms.size(); ++i) {
    const BodyPrism& prism = prisms[i];
    for (std::size_t k = 0; k < prism.outline.size(); ++k) {
      const Eigen::Vector2d &p = prism.outline[k], &q = prism.outline[(k + 1) % prism.outline.size()];
      const double length = (q - p).norm();
      if (length <= slivers.along_m) continue;
      const Eigen::Vector2d e = (q - p) / length;
      std::vector<Patch> patches = {{0.0, length, prism.z0, prism.z1}};
      Eigen::AlignedBox2d box(Eigen::Vector2d(p.cwiseMin(q).array() - touch_m),
                              Eigen::Vector2d(p.cwiseMax(q).array() + touch_m));
      grid.near(box, near);
      for (const int other : near) {
        const auto j = static_cast<std::size_t>(other);
        if (j == i || !boxes[j].intersects(box)) continue;
        // Parts of one body meet exactly; a wide reach would swallow the sharp corners between them.
        const double reach_m = prisms[j].element == prism.element ? std::min(touch_m, joint_m) : touch_m;
        const auto part = covered(p, e, length, prisms[j].outline, reach_m, i > j);
        if (part) subtract_patch({part->s0, part->s1, prisms[j].z0, prisms[j].z1}, slivers, patches);
      }
      for (const Patch& patch : patches)
        result.push_back({p + patch.s0 * e, p + patch.s1 * e, patch.z0, patch.z1, prism.element});
    }
  }
  return result;
}

SurfaceIndex::SurfaceIndex(std::vector<SurfaceRect> rects) : rects_(std::move(rects)), grid_(boxes_of(rects_)) {}

std::optional<SurfaceIndex::Nearest> SurfaceIndex::nearest(const Eigen::Vector3d& p, const Eigen::Vector2d& direction,
                                                           double reach_m) const {
  constexpr double first_reach_m = 0.05;
  constexpr double growth = 6.0;
  constexpr double other_way = -0.5;
  std::vector<int> found;
  for (double reach = std::min(first_reach_m, reach_m);; reach = std::min(growth * reach, reach_m)) {
    grid_.near({Eigen::Vector2d(p.head<2>().array() - reach), Eigen::Vector2d(p.head<2>().array() + reach)}, found);
    Nearest best{-1, reach};
    for (const int i : found) {
      const SurfaceRect& rect = rects_[static_cast<std::size_t>(i)];
      if (rect.direction().dot(direction) < other_way) continue;
      const double d = distance(rect, p);
      if (d < best.distance_m || (best.rect < 0 && d == best.distance_m)) best = {i, d};
    }
    if (best.rect >= 0) return best;
    if (reach >= reach_m) return std::nullopt;
  }
}

}  // namespace plumbline::bim
