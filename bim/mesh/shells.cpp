// SPDX-License-Identifier: Apache-2.0
#include "bim/mesh/shells.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

#include "bim/mesh/solid.h"
#include "bim/model/boxes.h"

namespace plumbline::bim {
namespace {

/// Number of the shell of each vertex, counted from the first vertex on.
std::vector<int> shell_numbers(const Solid& solid) {
  std::vector<int> root(solid.vertices.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int i) {
    while (root[static_cast<std::size_t>(i)] != i) {
      root[static_cast<std::size_t>(i)] = root[static_cast<std::size_t>(root[static_cast<std::size_t>(i)])];
      i = root[static_cast<std::size_t>(i)];
    }
    return i;
  };
  for (const Eigen::Vector3i& t : solid.triangles)
    for (int k = 1; k < 3; ++k) root[static_cast<std::size_t>(find(t[k]))] = find(t[0]);
  std::vector<int> number_of_root(solid.vertices.size(), -1), numbers;
  int count = 0;
  for (std::size_t i = 0; i < solid.vertices.size(); ++i) {
    int& number = number_of_root[static_cast<std::size_t>(find(static_cast<int>(i)))];
    if (number < 0) number = count++;
    numbers.push_back(number);
  }
  return numbers;
}

/// Shells by their numbers; of vertices without triangles there are empty ones.
std::vector<Solid> numbered_shells(const Solid& solid, const std::vector<int>& numbers) {
  std::vector<Solid> result;
  std::vector<int> place;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto number = static_cast<std::size_t>(numbers[i]);
    if (number == result.size()) result.emplace_back();
    place.push_back(static_cast<int>(result[number].vertices.size()));
    result[number].vertices.push_back(solid.vertices[i]);
  }
  for (const Eigen::Vector3i& t : solid.triangles)
    result[static_cast<std::size_t>(numbers[static_cast<std::size_t>(t[0])])].triangles.push_back(
        t.unaryExpr([&](int i) { return place[static_cast<std::size_t>(i)]; }));
  return result;
}

/// Share of all directions in which a closed surface is seen from p [vanoosterom1983]: 1 inside, 0 outside, between on
/// it.
double seen_from(const Solid& closed, const Eigen::Vector3d& p) {
  double sum = 0.0;
  for (const Eigen::Vector3i& t : closed.triangles) {
    const auto to = [&](int k) -> Eigen::Vector3d { return closed.vertices[static_cast<std::size_t>(t[k])] - p; };
    const Eigen::Vector3d a = to(0), b = to(1), c = to(2);
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    const double height = a.dot(b.cross(c));
    if (std::abs(height) <= 1e-12 * la * lb * lc) continue;  // in its plane
    sum += 2.0 * std::atan2(height, la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return std::abs(sum) / (4.0 * std::numbers::pi);
}

}  // namespace

std::vector<Solid> shells(const Solid& solid) {
  std::vector<Solid> result = numbered_shells(solid, shell_numbers(solid));
  std::erase_if(result, [](const Solid& part) { return part.triangles.empty(); });
  return result;
}

bool encloses(const Solid& outer, const Solid& inner) {
  constexpr double touching_m = 1e-4, outside = 0.02, inside = 0.9;
  const Eigen::AlignedBox3d box = box_of(outer);
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(touching_m);
  if (!Eigen::AlignedBox3d(box.min() - margin, box.max() + margin).contains(box_of(inner))) return false;
  bool deep = false;  // the same shell once more is in none
  for (const Eigen::Vector3d& p : inner.vertices) {
    const double seen = seen_from(outer, p);
    if (seen < outside) return false;
    deep = deep || seen > inside;
  }
  return deep;
}

Solid shells_turned_outward(const Solid& solid) {
  Solid result = turned_outward(solid);
  const std::vector<int> numbers = shell_numbers(result);
  const std::vector<Solid> parts = numbered_shells(result, numbers);
  if (parts.size() < 2) return result;
  std::vector<double> volumes;
  for (const Solid& part : parts) volumes.push_back(volume(part));
  std::vector<char> turned;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    bool stays = volumes[i] >= 0.0;
    for (std::size_t k = 0; k < parts.size() && !stays; ++k) stays = volumes[k] > 0.0 && encloses(parts[k], parts[i]);
    turned.push_back(stays ? 0 : 1);
  }
  for (Eigen::Vector3i& t : result.triangles)
    if (turned[static_cast<std::size_t>(numbers[static_cast<std::size_t>(t[0])])] != 0) std::swap(t[1], t[2]);
  return result;
}

Solid turned_alike(const Solid& solid) {
  std::map<std::pair<int, int>, std::vector<std::size_t>> sides;
  for (std::size_t t = 0; t < solid.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int a = solid.triangles[t][k], b = solid.triangles[t][(k + 1) % 3];
      sides[{std::min(a, b), std::max(a, b)}].push_back(t);
    }
  if (std::any_of(sides.begin(), sides.end(), [](const auto& side) { return side.second.size() != 2; })) return solid;
  Solid result = solid;
  const auto runs = [&](std::size_t t, int a, int b) {
    const Eigen::Vector3i& triangle = result.triangles[t];
    for (int k = 0; k < 3; ++k)
      if (triangle[k] == a && triangle[(k + 1) % 3] == b) return true;
    return false;
  };
  std::vector<char> seen(solid.triangles.size(), 0);
  for (std::size_t first = 0; first < seen.size(); ++first) {
    std::vector<std::size_t> open;
    if (std::exchange(seen[first], char{1}) == 0) open.push_back(first);
    while (!open.empty()) {
      const std::size_t t = open.back();
      open.pop_back();
      for (int k = 0; k < 3; ++k) {
        const int a = result.triangles[t][k], b = result.triangles[t][(k + 1) % 3];
        const std::vector<std::size_t>& both = sides[{std::min(a, b), std::max(a, b)}];
        const std::size_t next = both[0] == t ? both[1] : both[0];
        if (std::exchange(seen[next], char{1}) != 0) continue;
        if (runs(next, a, b)) std::swap(result.triangles[next][1], result.triangles[next][2]);
        open.push_back(next);
      }
    }
  }
  return is_closed(result) ? shells_turned_outward(result) : solid;
}

bool shells_may_overlap(const Solid& solid, double grid_m) {
  const std::vector<Solid> parts = shells(solid);
  if (parts.size() < 2 || !std::all_of(parts.begin(), parts.end(), is_closed)) return false;
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const Solid& part : shells(shells_turned_outward(solid)))
    if (volume(part) > 0.0) boxes.push_back(box_of(part));
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Eigen::Vector3d margin = Eigen::Vector3d::Constant(grid_m);
    const Eigen::AlignedBox3d reach(boxes[i].min() - margin, boxes[i].max() + margin);
    for (std::size_t k = i + 1; k < boxes.size(); ++k)
      if (reach.intersects(boxes[k])) return true;
  }
  return false;
}

}  // namespace plumbline::bim
