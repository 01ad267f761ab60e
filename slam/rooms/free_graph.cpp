// SPDX-License-Identifier: Apache-2.0
#include "slam/rooms/free_graph.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace plumbline::slam {

namespace {

constexpr int none = -1;

class Builder {
 public:
  Builder(const FreeGrid& grid, const std::vector<float>& distance_m, double spacing_m)
      : frame_(grid.frame), distance_m_(distance_m), spacing_m_(spacing_m) {
    graph_.owner.assign(frame_.size(), none);
  }

  FreeGraph build() {
    for (const std::size_t cell : by_decreasing_clearance(frame_, distance_m_)) own(cell);
    connect();
    return std::move(graph_);
  }

 private:
  void own(std::size_t cell) {
    const Uphill uphill = uphill_of(cell);
    const bool opens = uphill.highest == none || (uphill.covering == none && at(cell) >= spacing_m_);
    if (opens) {
      graph_.owner[cell] = static_cast<int>(graph_.vertices.size());
      graph_.vertices.push_back({cell, at(cell)});
    } else {
      graph_.owner[cell] = uphill.covering == none ? uphill.highest : uphill.covering;
    }
  }

  /// Owners of a cell's neighbours, none where there is none; ties: the first in row order.
  struct Uphill {
    int highest = none;   ///< of the highest one
    int covering = none;  ///< of the highest one whose vertex covers the cell
  };

  [[nodiscard]] Uphill uphill_of(std::size_t cell) const {
    const auto width = static_cast<std::size_t>(frame_.nx);
    const int i = static_cast<int>(cell % width), j = static_cast<int>(cell / width);
    Uphill uphill;
    double highest = -1.0, covering = -1.0;
    for (int dj = -1; dj <= 1; ++dj)
      for (int di = -1; di <= 1; ++di) {
        const int ni = i + di, nj = j + dj;
        if (ni < 0 || nj < 0 || ni >= frame_.nx || nj >= frame_.ny) continue;
        const std::size_t n = frame_.index(ni, nj);
        const int owner = graph_.owner[n];
        if (owner == none || at(n) <= std::min(highest, covering)) continue;
        if (at(n) > highest) {
          highest = at(n);
          uphill.highest = owner;
        }
        if (at(n) > covering && covers(owner, cell)) {
          covering = at(n);
          uphill.covering = owner;
        }
      }
    return uphill;
  }

  [[nodiscard]] bool covers(int owner, std::size_t cell) const {
    const FreeVertex& vertex = graph_.vertices[static_cast<std::size_t>(owner)];
    return (frame_.center(cell) - frame_.center(vertex.cell)).norm() <= std::max(spacing_m_, vertex.distance_m);
  }
  [[nodiscard]] double at(std::size_t cell) const { return static_cast<double>(distance_m_[cell]); }

  void connect() {
    std::vector<FreeEdge> steps;
    const auto width = static_cast<std::size_t>(frame_.nx);
    const auto step = [&](std::size_t from, std::size_t to) {
      const int a = graph_.owner[from], b = graph_.owner[to];
      if (a == none || b == none || a == b) return;
      steps.push_back(
          {std::min(a, b), std::max(a, b), static_cast<double>(std::min(distance_m_[from], distance_m_[to]))});
    };
    for (std::size_t k = 0; k < graph_.owner.size(); ++k) {
      if ((k + 1) % width != 0) step(k, k + 1);
      if (k + width < graph_.owner.size()) step(k, k + width);
    }
    std::sort(steps.begin(), steps.end(), [](const FreeEdge& p, const FreeEdge& q) {
      return std::tuple(p.a, p.b, -p.distance_m) < std::tuple(q.a, q.b, -q.distance_m);
    });
    for (const FreeEdge& s : steps)
      if (graph_.edges.empty() || graph_.edges.back().a != s.a || graph_.edges.back().b != s.b)
        graph_.edges.push_back(s);
  }

  const GridFrame& frame_;
  const std::vector<float>& distance_m_;
  double spacing_m_;
  FreeGraph graph_;
};

}  // namespace

FreeGraph free_graph(const FreeGrid& grid, const std::vector<float>& distance_m, double spacing_m) {
  return Builder(grid, distance_m, spacing_m).build();
}

std::vector<int> cluster_vertices(const FreeGraph& graph, double threshold_m, Removal removal) {
  const auto kept = [&](double distance_m) {
    return removal == Removal::near ? distance_m > threshold_m : distance_m <= threshold_m;
  };
  std::vector<int> root(graph.vertices.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int v) {
    while (root[static_cast<std::size_t>(v)] != v) v = root[static_cast<std::size_t>(v)];
    return v;
  };
  for (const FreeEdge& e : graph.edges) {
    const bool whole = kept(e.distance_m) && kept(graph.vertices[static_cast<std::size_t>(e.a)].distance_m) &&
                       kept(graph.vertices[static_cast<std::size_t>(e.b)].distance_m);
    if (!whole) continue;
    const int a = find(e.a), b = find(e.b);
    root[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }
  std::vector<int> cluster(graph.vertices.size(), none);
  for (std::size_t v = 0; v < cluster.size(); ++v)
    if (kept(graph.vertices[v].distance_m)) cluster[v] = find(static_cast<int>(v));
  for (bool changed = true; changed;) {
    changed = false;
    for (const FreeEdge& e : graph.edges) {
      int& a = cluster[static_cast<std::size_t>(e.a)];
      int& b = cluster[static_cast<std::size_t>(e.b)];
      if ((a == none) == (b == none)) continue;
      (a == none ? a : b) = a == none ? b : a;
      changed = true;
    }
  }
  return cluster;
}

}  // namespace plumbline::slam
