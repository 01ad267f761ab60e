// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

#include "bim/symmetry/symmetry_bodies.h"

namespace plumbline::bim {

namespace {

using Point = std::pair<double, double>;

Point key(const Eigen::Vector2d& p) { return {p.x(), p.y()}; }

/// Sine of the turn at a corner, positive to the left.
double turn(const Eigen::Vector2d& before, const Eigen::Vector2d& at, const Eigen::Vector2d& after) {
  const Eigen::Vector2d in = (at - before).normalized(), out = (after - at).normalized();
  return in.x() * out.y() - in.y() * out.x();
}

/// The polygon without corners at which it goes straight on.
Polygon2 without_straight(const Polygon2& polygon) {
  constexpr double straight = 1e-9;
  Polygon2 kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& before = kept.empty() ? polygon[(i + polygon.size() - 1) % polygon.size()] : kept.back();
    if (std::abs(turn(before, polygon[i], polygon[(i + 1) % polygon.size()])) > straight) kept.push_back(polygon[i]);
  }
  return kept;
}

bool is_convex(const Polygon2& polygon) {
  constexpr double rounding = 1e-9;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    if (turn(polygon[i], polygon[(i + 1) % polygon.size()], polygon[(i + 2) % polygon.size()]) < -rounding)
      return false;
  return true;
}

/// The polygon that two make over the side p to q of `left`, which `right` runs along the other way, and over what else
/// they share next to it.
Polygon2 joined(const Polygon2& left, const Polygon2& right, const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
  const auto from = [](const Polygon2& polygon, const Eigen::Vector2d& corner) {
    Polygon2 turned = polygon;
    std::rotate(turned.begin(), std::find(turned.begin(), turned.end(), corner), turned.end());
    return turned;
  };
  Polygon2 ring = from(left, q);  // q ... p
  const Polygon2 other = from(right, p);
  ring.insert(ring.end(), other.begin() + 1, other.end() - 1);  // without p and q
  for (std::size_t i = 0; ring.size() >= 3 && i < ring.size();) {
    const std::size_t after = (i + 1) % ring.size(), next = (i + 2) % ring.size();
    if (ring[i] != ring[next]) {
      ++i;
      continue;
    }
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(std::max(after, next)));
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(std::min(after, next)));
    i = 0;
  }
  return ring;
}

/// A side that two pieces share.
struct Shared {
  double length = 0.0;
  Eigen::Vector2d p = Eigen::Vector2d::Zero(), q = Eigen::Vector2d::Zero();
  std::size_t left = 0, right = 0;
};

std::vector<Shared> shared_sides(const std::vector<Polygon2>& pieces) {
  std::map<std::pair<Point, Point>, std::size_t> owner;
  std::vector<Shared> sides;
  for (std::size_t i = 0; i < pieces.size(); ++i)
    for (std::size_t k = 0; k < pieces[i].size(); ++k) {
      const Eigen::Vector2d &p = pieces[i][k], &q = pieces[i][(k + 1) % pieces[i].size()];
      if (const auto other = owner.find({key(q), key(p)}); other != owner.end())
        sides.push_back({(q - p).norm(), p, q, i, other->second});
      owner.emplace(std::pair(key(p), key(q)), i);
    }
  // Diagonals before what is narrow between them.
  std::stable_sort(sides.begin(), sides.end(), [](const Shared& a, const Shared& b) { return a.length > b.length; });
  return sides;
}

bool has_side(const Polygon2& polygon, const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
  const auto at = std::find(polygon.begin(), polygon.end(), p);
  if (at == polygon.end()) return false;
  return (at + 1 == polygon.end() ? polygon.front() : *(at + 1)) == q;
}

}  // namespace

std::vector<Polygon2> convex_parts(std::vector<Polygon2> pieces) {
  std::vector<std::size_t> part(pieces.size());
  std::iota(part.begin(), part.end(), std::size_t{0});
  const auto root = [&](std::size_t i) {
    while (part[i] != i) i = part[i];
    return i;
  };
  for (const Shared& side : shared_sides(pieces)) {
    const std::size_t left = root(side.left), right = root(side.right);
    // A corner between them may have gone straight.
    if (left == right || !has_side(pieces[left], side.p, side.q) || !has_side(pieces[right], side.q, side.p)) continue;
    Polygon2 ring = joined(pieces[left], pieces[right], side.p, side.q);
    if (!is_convex(ring)) continue;
    pieces[left] = std::move(ring);
    part[right] = left;
  }
  std::vector<Polygon2> result;
  for (std::size_t i = 0; i < pieces.size(); ++i)
    if (part[i] == i) result.push_back(without_straight(pieces[i]));
  std::erase_if(result, [](const Polygon2& polygon) { return polygon.size() < 3; });
  return result;
}

}  // namespace plumbline::bim
