// SPDX-License-Identifier: Apache-2.0
#include "bim/mesh/solid.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <tuple>

#include "bim/geometry/polygon_boolean.h"

namespace plumbline::bim {

namespace {

using Key = std::tuple<double, double, double>;

Eigen::Vector3d snapped(const Eigen::Vector3d& p, double grid_m) {
  return {snap(p.x(), grid_m), snap(p.y(), grid_m), snap(p.z(), grid_m)};
}

/// Adding zero turns -0 into +0, so that equal positions are equal keys and equal bytes.
Key key(const Eigen::Vector3d& p) { return {p.x() + 0.0, p.y() + 0.0, p.z() + 0.0}; }

Eigen::Vector3i lowest_first(const Eigen::Vector3i& t) {
  if (t[0] <= t[1] && t[0] <= t[2]) return t;
  return t[1] <= t[2] ? Eigen::Vector3i(t[1], t[2], t[0]) : Eigen::Vector3i(t[2], t[0], t[1]);
}

bool before(const Eigen::Vector3i& a, const Eigen::Vector3i& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

}  // namespace

double volume(const Solid& solid) {
  if (solid.vertices.empty()) return 0.0;
  const Eigen::Vector3d origin = solid.vertices.front();
  double six = 0.0;
  for (const Eigen::Vector3i& t : solid.triangles) {
    const auto corner = [&](int i) -> Eigen::Vector3d {
      return solid.vertices[static_cast<std::size_t>(t[i])] - origin;
    };
    six += corner(0).dot(corner(1).cross(corner(2)));
  }
  return six / 6.0;
}

bool is_closed(const Solid& solid) {
  std::map<std::array<int, 2>, int> uses;
  for (const Eigen::Vector3i& t : solid.triangles) {
    for (int i = 0; i < 3; ++i) {
      const int from = t[i], to = t[(i + 1) % 3];
      if (from == to || ++uses[{from, to}] > 1) return false;
    }
  }
  return !uses.empty() && std::all_of(uses.begin(), uses.end(), [&](const auto& use) {
    return uses.contains({use.first[1], use.first[0]});
  });
}

Solid canonical(const Solid& solid, double grid_m) {
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& p : solid.vertices) points.push_back(snapped(p, grid_m));
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return key(points[static_cast<std::size_t>(a)]) < key(points[static_cast<std::size_t>(b)]);
  });
  Solid result;
  std::vector<int> rank(points.size());
  for (const int old : order) {
    rank[static_cast<std::size_t>(old)] = static_cast<int>(result.vertices.size());
    result.vertices.push_back(points[static_cast<std::size_t>(old)] + Eigen::Vector3d::Zero());
  }
  for (const Eigen::Vector3i& t : solid.triangles)
    result.triangles.push_back(lowest_first(t.unaryExpr([&](int i) { return rank[static_cast<std::size_t>(i)]; })));
  std::sort(result.triangles.begin(), result.triangles.end(), before);
  return result;
}

Solid welded(const Solid& solid, double grid_m) {
  std::map<Key, int> index;
  std::vector<int> joined;
  Solid result;
  for (const Eigen::Vector3d& p : solid.vertices) {
    const Eigen::Vector3d q = snapped(p, grid_m);
    const auto [place, is_new] = index.try_emplace(key(q), static_cast<int>(result.vertices.size()));
    if (is_new) result.vertices.push_back(q);
    joined.push_back(place->second);
  }
  for (const Eigen::Vector3i& t : solid.triangles) {
    const Eigen::Vector3i j = t.unaryExpr([&](int i) { return joined[static_cast<std::size_t>(i)]; });
    if (j[0] != j[1] && j[1] != j[2] && j[2] != j[0]) result.triangles.push_back(j);
  }
  return result;
}

Solid turned_outward(const Solid& solid) {
  Solid result = solid;
  if (volume(solid) < 0.0)
    for (Eigen::Vector3i& t : result.triangles) std::swap(t[1], t[2]);
  return result;
}

namespace {

/// Corner opposite to the longest side, of equal ones the first.
int top_corner(const Solid& solid, const Eigen::Vector3i& t) {
  int top = 0;
  double longest = -1.0;
  for (int k = 0; k < 3; ++k) {
    const double side = (solid.vertices[static_cast<std::size_t>(t[(k + 1) % 3])] -
                         solid.vertices[static_cast<std::size_t>(t[(k + 2) % 3])])
                            .norm();
    if (side <= longest) continue;
    longest = side;
    top = k;
  }
  return top;
}

bool is_sliver(const Solid& solid, const Eigen::Vector3i& t, double grid_m) {
  const auto p = [&](int k) { return solid.vertices[static_cast<std::size_t>(t[k % 3])]; };
  const int top = top_corner(solid, t);
  const double side = (p(top + 1) - p(top + 2)).norm();
  return (p(1) - p(0)).cross(p(2) - p(0)).norm() <= grid_m * side;
}

}  // namespace

Solid without_slivers(Solid solid, double grid_m) {
  std::map<std::pair<int, int>, int> owner;  // of each directed edge
  const auto enter = [&](int t) {
    const Eigen::Vector3i& triangle = solid.triangles[static_cast<std::size_t>(t)];
    for (int k = 0; k < 3; ++k) owner[{triangle[k], triangle[(k + 1) % 3]}] = t;
  };
  for (int t = 0; t < static_cast<int>(solid.triangles.size()); ++t) enter(t);
  // Turning one may make another of its neighbour, further along the line; a few rounds take them all.
  constexpr int most_rounds = 8;
  for (int round = 0, turned = 1; round < most_rounds && turned > 0; ++round) {
    turned = 0;
    for (int t = 0; t < static_cast<int>(solid.triangles.size()); ++t) {
      Eigen::Vector3i& triangle = solid.triangles[static_cast<std::size_t>(t)];
      if (!is_sliver(solid, triangle, grid_m)) continue;
      const int top = top_corner(solid, triangle);
      const int b = triangle[top], c = triangle[(top + 1) % 3], a = triangle[(top + 2) % 3];
      const auto beyond = owner.find({a, c});
      if (beyond == owner.end() || beyond->second == t) continue;
      Eigen::Vector3i& other = solid.triangles[static_cast<std::size_t>(beyond->second)];
      const int d = other.sum() - a - c;
      if (d == b || owner.contains({b, d}) || owner.contains({d, b})) continue;
      const int neighbour = beyond->second;
      owner.erase({a, c});
      owner.erase({c, a});
      triangle = {a, b, d};
      other = {b, c, d};
      enter(t);
      enter(neighbour);
      ++turned;
    }
  }
  return solid;
}

Solid widened(const Solid& closed, double by_m) {
  constexpr double same_plane = 1e-6, most = 10.0;
  std::vector<std::vector<Eigen::Vector3d>> normals(closed.vertices.size());
  for (const Eigen::Vector3i& t : closed.triangles) {
    const auto p = [&](int k) -> const Eigen::Vector3d& { return closed.vertices[static_cast<std::size_t>(t[k])]; };
    const Eigen::Vector3d n = (p(1) - p(0)).cross(p(2) - p(0)).normalized();
    if (n.isZero()) continue;
    for (const int i : t) {
      std::vector<Eigen::Vector3d>& own = normals[static_cast<std::size_t>(i)];
      if (std::none_of(own.begin(), own.end(), [&](const Eigen::Vector3d& m) { return (m - n).norm() < same_plane; }))
        own.push_back(n);
    }
  }
  Solid result = closed;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    if (normals[i].empty()) continue;
    Eigen::MatrixXd planes(static_cast<Eigen::Index>(normals[i].size()), 3);
    for (std::size_t k = 0; k < normals[i].size(); ++k) planes.row(static_cast<Eigen::Index>(k)) = normals[i][k];
    const Eigen::VectorXd wanted = Eigen::VectorXd::Constant(planes.rows(), by_m);
    const Eigen::Vector3d move = planes.completeOrthogonalDecomposition().solve(wanted);
    result.vertices[i] += move * std::min(1.0, most * by_m / move.norm());
  }
  return result;
}

}  // namespace plumbline::bim
