// SPDX-License-Identifier: Apache-2.0
#include "bim/model/straight_pieces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "bim/geometry/interval.h"
#include "bim/model/hull.h"

namespace plumbline::bim {

namespace {

/// Material between two parallel faces: from `foot` along `e`, `thickness_m` to the left.
struct Strip {
  Eigen::Vector2d foot = Eigen::Vector2d::Zero(), e = Eigen::Vector2d::UnitX();
  double length_m = 0.0, thickness_m = 0.0;

  /// With its ends moved out.
  [[nodiscard]] Polygon2 outline(double beyond_m) const {
    const Eigen::Vector2d left(-e.y(), e.x()), a = foot - beyond_m * e, b = foot + (length_m + beyond_m) * e;
    return {a, b, b + thickness_m * left, a + thickness_m * left};
  }
};

std::vector<Eigen::Vector2d> ends_of_edges(const Region2& region) {
  std::vector<Eigen::Vector2d> ends;
  const auto add = [&](const Polygon2& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      ends.push_back(ring[i]);
      ends.push_back(ring[(i + 1) % ring.size()]);
    }
  };
  for (const PolygonWithHoles2& piece : region) {
    add(piece.outer);
    for (const Polygon2& hole : piece.holes) add(hole);
  }
  return ends;
}

/// Stretches where two faces lie against each other, the longest first.
std::vector<Strip> strips_of(const Region2& region, const StraightPiecesConfig& config) {
  constexpr double tilt = 2e-3, least_thickness_m = 0.02;
  const std::vector<Eigen::Vector2d> ends = ends_of_edges(region);
  std::vector<Strip> strips;
  for (std::size_t i = 0; i < ends.size(); i += 2) {
    const Eigen::Vector2d e = (ends[i + 1] - ends[i]).normalized(), left(-e.y(), e.x());
    const double length = (ends[i + 1] - ends[i]).norm();
    if (length < config.least_length_m) continue;
    for (std::size_t j = 0; j < ends.size(); j += 2) {
      const Eigen::Vector2d p = ends[j] - ends[i], q = ends[j + 1] - ends[i];
      if (q.dot(e) >= p.dot(e) || std::abs((q - p).normalized().dot(left)) > tilt) continue;
      const double thickness = 0.5 * (p.dot(left) + q.dot(left));
      if (thickness < least_thickness_m || thickness > config.most_thickness_m) continue;
      const double low = std::max(0.0, q.dot(e)), high = std::min(length, p.dot(e));
      if (high - low < std::max(config.least_length_m, config.slimness * thickness)) continue;
      strips.push_back({ends[i] + low * e, e, high - low, thickness});
    }
  }
  std::stable_sort(strips.begin(), strips.end(),
                   [](const Strip& a, const Strip& b) { return a.length_m > b.length_m; });
  if (strips.size() > config.most_strips) strips.resize(config.most_strips);
  return strips;
}

/// All that lies between the two faces and hangs together with the strip; nullopt where the strip is not full, or that
/// is not convex.
std::optional<Polygon2> piece_of(const Region2& region, const Strip& strip) {
  constexpr double full = 0.995, far_m = 1e3;
  if (area(intersect(region, unite(std::vector<Polygon2>{strip.outline(0.0)}))) <
      full * strip.length_m * strip.thickness_m)
    return std::nullopt;
  const Eigen::Vector2d middle = centroid(strip.outline(0.0));
  for (const PolygonWithHoles2& part : intersect(region, unite(std::vector<Polygon2>{strip.outline(far_m)}))) {
    if (!contains(part, middle)) continue;
    const Polygon2 hull = convex_hull(part.outer);
    if (!part.holes.empty() || signed_area(part.outer) < full * signed_area(hull)) break;
    Interval along;
    for (const Eigen::Vector2d& p : hull) along.add((p - strip.foot).dot(strip.e));
    // A rectangle has flat faces, the rounded corners of the section do not.
    const Strip whole{strip.foot + along.low * strip.e, strip.e, along.length(), strip.thickness_m};
    const bool square = signed_area(hull) > full * whole.length_m * whole.thickness_m;
    return square ? whole.outline(0.0) : hull;
  }
  return strip.outline(0.0);
}

}  // namespace

std::vector<Polygon2> straight_pieces(const Region2& section, const StraightPiecesConfig& config) {
  std::vector<Polygon2> pieces;
  Region2 rest = section;
  while (area(rest) > config.least_rest_m2) {
    std::optional<Polygon2> piece;
    for (const Strip& strip : strips_of(rest, config)) {
      std::optional<Polygon2> other = piece_of(rest, strip);
      if (other && (!piece || signed_area(*other) > signed_area(*piece) + config.least_rest_m2))
        piece = std::move(other);
    }
    if (!piece || pieces.size() == config.most_pieces) return {};
    rest = subtract(rest, std::vector<Polygon2>{*piece});
    pieces.push_back(std::move(*piece));
  }
  return pieces.size() < 2 ? std::vector<Polygon2>{} : pieces;
}

}  // namespace plumbline::bim
