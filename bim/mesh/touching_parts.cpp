// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "bim/mesh/exact_boolean.h"

namespace plumbline::bim {
namespace {

/// One side of a triangle: corners from (k) to (k + 1).
struct Side {
  int triangle = 0;
  int corner = 0;
};

class Separation {
 public:
  explicit Separation(const Solid& soup) : soup_(soup), joined_(3 * soup.triangles.size()) {
    std::iota(joined_.begin(), joined_.end(), 0);
  }

  Solid separated() {
    std::map<std::array<int, 2>, std::vector<Side>> edges;
    for (std::size_t t = 0; t < soup_.triangles.size(); ++t) {
      for (int k = 0; k < 3; ++k) {
        const int a = soup_.triangles[t][k], b = soup_.triangles[t][(k + 1) % 3];
        edges[{std::min(a, b), std::max(a, b)}].push_back({static_cast<int>(t), k});
      }
    }
    for (auto& [ends, sides] : edges) pair_up(ends, sides);
    // Corners that were joined along edges share a vertex; others at the same place get their own.
    std::map<int, int> vertex_of;
    Solid result;
    for (std::size_t t = 0; t < soup_.triangles.size(); ++t) {
      Eigen::Vector3i triangle;
      for (int k = 0; k < 3; ++k) {
        const auto [place, is_new] =
            vertex_of.try_emplace(root(3 * static_cast<int>(t) + k), static_cast<int>(result.vertices.size()));
        if (is_new) result.vertices.push_back(soup_.vertices[static_cast<std::size_t>(soup_.triangles[t][k])]);
        triangle[k] = place->second;
      }
      result.triangles.push_back(triangle);
    }
    return result;
  }

 private:
  [[nodiscard]] int from(const Side& s) const {
    return soup_.triangles[static_cast<std::size_t>(s.triangle)][s.corner];
  }

  /// Neighbours of a side that runs forward are the nearest ones that run back, going round through the material.
  void pair_up(const std::array<int, 2>& ends, std::vector<Side>& sides) {
    constexpr double coincident = 1e-9;
    const auto p = [&](int i) -> const Eigen::Vector3d& { return soup_.vertices[static_cast<std::size_t>(i)]; };
    const Eigen::Vector3d axis = (p(ends[1]) - p(ends[0])).normalized();
    const Eigen::Vector3d u = axis.unitOrthogonal(), v = axis.cross(u);
    const auto angle = [&](const Side& s) {
      const int third = soup_.triangles[static_cast<std::size_t>(s.triangle)][(s.corner + 2) % 3];
      const Eigen::Vector3d d = p(third) - p(ends[0]);
      return std::atan2(d.dot(v), d.dot(u));
    };
    std::vector<std::pair<double, Side>> forward, back;
    for (const Side& s : sides) (from(s) == ends[0] ? forward : back).emplace_back(angle(s), s);
    std::vector<char> taken(back.size(), 0);
    for (const auto& [at, side] : forward) {
      std::size_t best = back.size();
      double least = 0.0;
      for (std::size_t i = 0; i < back.size(); ++i) {
        if (taken[i] != 0) continue;
        // The normal of a triangle that runs along the axis points to larger angles, its material lies at smaller ones.
        // Between two that coincide there is none.
        double turn = at - back[i].first;
        while (turn < coincident) turn += 2.0 * M_PI;
        if (best == back.size() || turn < least) {
          best = i;
          least = turn;
        }
      }
      if (best == back.size()) return;
      taken[best] = 1;
      const Side& other = back[best].second;
      join(side, 0, other, 1);
      join(side, 1, other, 0);
    }
  }

  void join(const Side& a, int ka, const Side& b, int kb) {
    const int i = root(3 * a.triangle + (a.corner + ka) % 3), j = root(3 * b.triangle + (b.corner + kb) % 3);
    joined_[static_cast<std::size_t>(std::max(i, j))] = std::min(i, j);
  }

  int root(int i) {
    while (joined_[static_cast<std::size_t>(i)] != i) i = joined_[static_cast<std::size_t>(i)];
    return i;
  }

  const Solid& soup_;
  std::vector<int> joined_;  ///< corners, 3 a triangle, that share a vertex
};

}  // namespace

Solid touching_parts_separated(const Solid& soup) { return Separation(soup).separated(); }

}  // namespace plumbline::bim
