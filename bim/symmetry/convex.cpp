// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "bim/model/boxes.h"
#include "bim/symmetry/body_grid.h"
#include "bim/symmetry/symmetry_bodies.h"

namespace plumbline::bim {

namespace {

/// Line through edge k of a counter-clockwise polygon; inside is n.p <= d.
struct Side {
  Eigen::Vector2d n;
  double d = 0.0;
};

Side side_of(const Polygon2& polygon, std::size_t k) {
  const Eigen::Vector2d& p = polygon[k];
  const Eigen::Vector2d e = polygon[(k + 1) % polygon.size()] - p;
  const Eigen::Vector2d n(e.y(), -e.x());
  return {n, n.dot(p)};
}

bool large(const Polygon2& polygon, const SymmetryBodiesConfig& config) {
  return polygon.size() >= 3 && signed_area(polygon) > config.area_min_m2;
}

/// Appends `body` without `taken` to `left`: the parts beside, below and above it.
void subtract_one(const BodyPrism& body, const BodyPrism& taken, const SymmetryBodiesConfig& config,
                  std::vector<BodyPrism>& left) {
  const double low = std::max(body.z0, taken.z0), high = std::min(body.z1, taken.z1);
  if (high <= low || !large(convex_intersection(body.outline, taken.outline), config)) {
    left.push_back(body);
    return;
  }
  Polygon2 rest = body.outline;
  for (std::size_t k = 0; k < taken.outline.size(); ++k) {
    const Side side = side_of(taken.outline, k);
    const Polygon2 beside = clipped(rest, -side.n, -side.d);
    if (large(beside, config)) left.push_back({beside, body.z0, body.z1, body.element});
    rest = clipped(rest, side.n, side.d);
  }
  if (low > body.z0) left.push_back({rest, body.z0, low, body.element});
  if (body.z1 > high) left.push_back({rest, high, body.z1, body.element});
}

}  // namespace

Polygon2 clipped(const Polygon2& polygon, const Eigen::Vector2d& n, double d) {
  Polygon2 result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double hp = n.dot(p) - d, hq = n.dot(q) - d;
    if (hp <= 0.0) result.push_back(p);
    if ((hp < 0.0 && hq > 0.0) || (hp > 0.0 && hq < 0.0)) result.push_back(p + hp / (hp - hq) * (q - p));
  }
  return result;
}

Polygon2 convex_intersection(Polygon2 a, const Polygon2& b) {
  for (std::size_t k = 0; k < b.size() && a.size() >= 3; ++k) {
    const Side side = side_of(b, k);
    a = clipped(a, side.n, side.d);
  }
  return a;
}

std::vector<BodyPrism> without_overlaps(const std::vector<BodyPrism>& prisms, const SymmetryBodiesConfig& config) {
  std::vector<Eigen::AlignedBox2d> boxes;
  boxes.reserve(prisms.size());
  for (const BodyPrism& prism : prisms) boxes.push_back(box_of(prism.outline));
  const BodyGrid grid(boxes);
  std::vector<BodyPrism> result;
  std::vector<int> near;
  for (std::size_t i = 0; i < prisms.size(); ++i) {
    std::vector<BodyPrism> parts = {prisms[i]};
    grid.near(boxes[i], near);
    for (const int j : near) {
      if (j >= static_cast<int>(i) || !boxes[static_cast<std::size_t>(j)].intersects(boxes[i])) continue;
      std::vector<BodyPrism> left;
      for (const BodyPrism& part : parts) subtract_one(part, prisms[static_cast<std::size_t>(j)], config, left);
      parts = std::move(left);
    }
    result.insert(result.end(), parts.begin(), parts.end());
  }
  return result;
}

double volume(const std::vector<BodyPrism>& disjoint) {
  double sum = 0.0;
  for (const BodyPrism& prism : disjoint) sum += signed_area(prism.outline) * (prism.z1 - prism.z0);
  return sum;
}

}  // namespace plumbline::bim
