// SPDX-License-Identifier: Apache-2.0
#include "slam/rooms/clusters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace plumbline::slam {

namespace {

constexpr int none = -1;

/// Lower envelope of parabolas: squared distance transform of one line [Felzenszwalb, Huttenlocher 2012].
class LineTransform {
 public:
  explicit LineTransform(int n) : f_(static_cast<std::size_t>(n)), v_(f_.size()), z_(f_.size() + 1), out_(f_.size()) {}

  std::vector<float>& input() { return f_; }

  const std::vector<float>& run() {
    std::size_t k = 0;
    v_[0] = 0;
    z_[0] = -infinity;
    z_[1] = infinity;
    for (std::size_t q = 1; q < f_.size(); ++q) {
      float s = cross(q, v_[k]);
      while (s <= z_[k]) s = cross(q, v_[--k]);
      v_[++k] = q;
      z_[k] = s;
      z_[k + 1] = infinity;
    }
    k = 0;
    for (std::size_t q = 0; q < f_.size(); ++q) {
      while (z_[k + 1] < static_cast<float>(q)) ++k;
      const float d = static_cast<float>(q) - static_cast<float>(v_[k]);
      out_[q] = d * d + f_[v_[k]];
    }
    return out_;
  }

  static constexpr float infinity = 1e12F;

 private:
  [[nodiscard]] float cross(std::size_t q, std::size_t p) const {
    const auto x = static_cast<float>(q), y = static_cast<float>(p);
    return ((f_[q] + x * x) - (f_[p] + y * y)) / (2.0F * (x - y));
  }
  std::vector<float> f_;
  std::vector<std::size_t> v_;
  std::vector<float> z_, out_;
};

/// Basins of the clearance landscape as a union-find over hilltops.
class Basins {
 public:
  Basins(const GridFrame& frame, const std::vector<float>& height, double neck_ratio)
      : frame_(frame), height_(height), neck_ratio_(static_cast<float>(neck_ratio)), label_(frame.size(), none) {}

  /// Cells by falling height, ties by index.
  void flood() {
    for (const std::size_t cell : by_falling_clearance(frame_, height_)) add(cell);
  }

  [[nodiscard]] int root_of(std::size_t cell) { return label_[cell] == none ? none : find(label_[cell]); }
  [[nodiscard]] std::size_t count() const { return parent_.size(); }
  [[nodiscard]] float top(int basin) const { return top_[static_cast<std::size_t>(basin)]; }

 private:
  void add(std::size_t cell) {
    const auto width = static_cast<std::size_t>(frame_.nx);
    const int i = static_cast<int>(cell % width), j = static_cast<int>(cell / width);
    std::array<int, 8> met{};
    int count = 0;
    int uphill = none;
    float uphill_height = -1.0F;
    for (int dj = -1; dj <= 1; ++dj)
      for (int di = -1; di <= 1; ++di) {
        const int ni = i + di, nj = j + dj;
        if ((di == 0 && dj == 0) || ni < 0 || nj < 0 || ni >= frame_.nx || nj >= frame_.ny) continue;
        const std::size_t n = frame_.index(ni, nj);
        if (label_[n] == none) continue;
        const int root = find(label_[n]);
        met[static_cast<std::size_t>(count++)] = root;
        if (height_[n] > uphill_height) {
          uphill_height = height_[n];
          uphill = root;
        }
      }
    if (uphill == none) {
      uphill = static_cast<int>(parent_.size());
      parent_.push_back(uphill);
      top_.push_back(height_[cell]);
    }
    label_[cell] = uphill;
    for (int m = 0; m < count; ++m) meet(uphill, met[static_cast<std::size_t>(m)], height_[cell]);
  }

  void meet(int a, int b, float pass) {
    a = find(a);
    b = find(b);
    if (a == b) return;
    // The older hilltop is the higher one, since cells come by falling height.
    const int high = std::min(a, b), low = std::max(a, b);
    if (pass >= neck_ratio_ * top(low)) parent_[static_cast<std::size_t>(low)] = high;
  }

  int find(int a) {
    while (parent_[static_cast<std::size_t>(a)] != a) a = parent_[static_cast<std::size_t>(a)];
    return a;
  }

  const GridFrame& frame_;
  const std::vector<float>& height_;
  float neck_ratio_;
  std::vector<int> label_;
  std::vector<int> parent_;
  std::vector<float> top_;
};

void find_boundary(const GridFrame& frame, const std::vector<int>& owner, int id, Cluster& cluster) {
  const auto width = static_cast<std::size_t>(frame.nx);
  for (const std::size_t cell : cluster.cells) {
    const std::size_t i = cell % width, j = cell / width;
    const bool inside = i > 0 && j > 0 && i + 1 < width && j + 1 < static_cast<std::size_t>(frame.ny) &&
                        owner[cell - 1] == id && owner[cell + 1] == id && owner[cell - width] == id &&
                        owner[cell + width] == id;
    if (!inside) cluster.boundary.push_back(cell);
  }
}

/// From its cells.
void measure(const GridFrame& frame, const std::vector<int>& owner, int id, Cluster& cluster) {
  cluster.area_m2 = static_cast<double>(cluster.cells.size()) * frame.cell * frame.cell;
  for (const std::size_t cell : cluster.cells) cluster.center_M += frame.center(cell);
  cluster.center_M /= static_cast<double>(cluster.cells.size());
  find_boundary(frame, owner, id, cluster);
}

/// Clusters from the owner of every cell; those that are too small or too narrow are left out. top[id]: clearance.
std::vector<Cluster> collect(const FreeGrid& grid, const std::vector<int>& owner, const std::vector<double>& top,
                             const ClusterConfig& config) {
  std::vector<Cluster> all(top.size());
  for (std::size_t cell = 0; cell < owner.size(); ++cell)
    if (owner[cell] != none) all[static_cast<std::size_t>(owner[cell])].cells.push_back(cell);
  std::vector<Cluster> kept;
  for (std::size_t id = 0; id < all.size(); ++id) {
    Cluster& c = all[id];
    c.clearance_m = top[id];
    const double area_m2 = static_cast<double>(c.cells.size()) * grid.frame.cell * grid.frame.cell;
    if (c.clearance_m < config.min_clearance_m || area_m2 < config.min_area_m2) continue;
    measure(grid.frame, owner, static_cast<int>(id), c);
    kept.push_back(std::move(c));
  }
  return kept;
}

std::vector<Cluster> cut_at_necks(const FreeGrid& grid, const std::vector<float>& height, const ClusterConfig& config) {
  Basins basins(grid.frame, height, config.neck_ratio);
  basins.flood();
  std::vector<int> owner(grid.frame.size(), none);
  for (std::size_t cell = 0; cell < owner.size(); ++cell) owner[cell] = basins.root_of(cell);
  std::vector<double> top;
  for (std::size_t id = 0; id < basins.count(); ++id)
    top.push_back(static_cast<double>(basins.top(static_cast<int>(id))));
  return collect(grid, owner, top, config);
}

std::vector<Cluster> cut_at_threshold(const FreeGrid& grid, const std::vector<float>& height,
                                      const ClusterConfig& config) {
  const FreeGraph graph = free_graph(grid, height, config.spacing_m);
  const std::vector<int> cluster = cluster_vertices(graph, config.threshold_m, config.removal);
  std::vector<double> top(graph.vertices.size(), 0.0);
  for (std::size_t v = 0; v < cluster.size(); ++v)
    if (cluster[v] != none) {
      double& highest = top[static_cast<std::size_t>(cluster[v])];
      highest = std::max(highest, graph.vertices[v].distance_m);
    }
  std::vector<int> owner(grid.frame.size(), none);
  for (std::size_t cell = 0; cell < owner.size(); ++cell)
    if (graph.owner[cell] != none) owner[cell] = cluster[static_cast<std::size_t>(graph.owner[cell])];
  return collect(grid, owner, top, config);
}

}  // namespace

Cluster cluster_of(const FreeGrid& grid, std::vector<std::size_t> cells) {
  std::vector<int> owner(grid.frame.size(), none);
  for (const std::size_t cell : cells) owner[cell] = 0;
  Cluster cluster;
  cluster.cells = std::move(cells);
  measure(grid.frame, owner, 0, cluster);
  return cluster;
}

std::vector<float> clearance(const FreeGrid& grid) {
  const GridFrame& f = grid.frame;
  std::vector<float> d(f.size());
  LineTransform column(f.ny), row(f.nx);
  std::vector<std::uint8_t> in_column(static_cast<std::size_t>(f.nx), 0);
  for (std::size_t k = 0, i = 0; k < f.size(); ++k, i = i + 1 == in_column.size() ? 0 : i + 1)
    in_column[i] |= grid.free[k];
  for (int i = 0; i < f.nx; ++i) {
    if (in_column[static_cast<std::size_t>(i)] == 0) continue;
    for (int j = 0; j < f.ny; ++j)
      column.input()[static_cast<std::size_t>(j)] = grid.free[f.index(i, j)] != 0 ? LineTransform::infinity : 0.0F;
    const std::vector<float>& out = column.run();
    for (int j = 0; j < f.ny; ++j)
      d[f.index(i, j)] = std::min(out[static_cast<std::size_t>(j)], LineTransform::infinity);
  }
  for (int j = 0; j < f.ny; ++j) {
    const auto first = grid.free.begin() + static_cast<std::ptrdiff_t>(f.index(0, j));
    if (std::find(first, first + f.nx, std::uint8_t{1}) == first + f.nx) continue;
    for (int i = 0; i < f.nx; ++i) row.input()[static_cast<std::size_t>(i)] = d[f.index(i, j)];
    const std::vector<float>& out = row.run();
    for (int i = 0; i < f.nx; ++i)
      d[f.index(i, j)] = static_cast<float>(f.cell) * std::sqrt(out[static_cast<std::size_t>(i)]);
  }
  return d;
}

std::vector<std::size_t> by_falling_clearance(const GridFrame& frame, const std::vector<float>& clearance_m) {
  // Squares of distances between cells are whole numbers of cells, so counting sorts them.
  const double scale = 1.0 / (frame.cell * frame.cell);
  const auto level = [&](std::size_t k) {
    const auto h = static_cast<double>(clearance_m[k]);
    return static_cast<std::size_t>(std::lround(h * h * scale));
  };
  std::vector<std::size_t> start;
  for (std::size_t k = 0; k < clearance_m.size(); ++k) {
    if (clearance_m[k] == 0.0F) continue;
    const std::size_t l = level(k);
    if (l >= start.size()) start.resize(l + 1, 0);
    ++start[l];
  }
  std::size_t above = 0;
  for (std::size_t l = start.size(); l-- > 1;) {
    const std::size_t count = start[l];
    start[l] = above;
    above += count;
  }
  std::vector<std::size_t> order(above);
  for (std::size_t k = 0; k < clearance_m.size(); ++k) {
    if (clearance_m[k] == 0.0F) continue;
    if (const std::size_t l = level(k); l > 0) order[start[l]++] = k;
  }
  return order;
}

std::vector<Cluster> clusters(const FreeGrid& grid, const ClusterConfig& config) {
  if (grid.frame.size() == 0) return {};
  const std::vector<float> height = clearance(grid);
  return config.cut == Cut::necks ? cut_at_necks(grid, height, config) : cut_at_threshold(grid, height, config);
}

}  // namespace plumbline::slam
