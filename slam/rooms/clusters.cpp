// SPDX-License-Identifier: Apache-2.0
#include "slam/rooms/clusters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>

namespace plumbline::slam {

namespace {

constexpr int none = -1;

/// More cells than a grid has in one column.
constexpr float far = 1e6F;

/// Lower envelope of parabolas: squared distance transform of one line [felzenszwalb2012].
class LineTransform {
 public:
  explicit LineTransform(int longest) : v_(static_cast<std::size_t>(longest)), z_(v_.size() + 1), out_(v_.size()) {}

  void run(std::span<const float> f) {
    std::size_t k = 0;
    v_[0] = 0;
    z_[0] = -infinity;
    z_[1] = infinity;
    for (std::size_t q = 1; q < f.size(); ++q) {
      float s = cross(f, q, v_[k]);
      while (s <= z_[k]) s = cross(f, q, v_[--k]);
      v_[++k] = q;
      z_[k] = s;
      z_[k + 1] = infinity;
    }
    k = 0;
    for (std::size_t q = 0; q < f.size(); ++q) {
      while (z_[k + 1] < static_cast<float>(q)) ++k;
      const float d = static_cast<float>(q) - static_cast<float>(v_[k]);
      out_[q] = d * d + f[v_[k]];
    }
  }
  /// Of the line's cells.
  [[nodiscard]] const std::vector<float>& out() const { return out_; }

  static constexpr float infinity = 1e12F;

 private:
  static float cross(std::span<const float> f, std::size_t q, std::size_t p) {
    const auto x = static_cast<float>(q), y = static_cast<float>(p);
    return ((f[q] + x * x) - (f[p] + y * y)) / (2.0F * (x - y));
  }
  std::vector<std::size_t> v_;
  std::vector<float> z_, out_;
};

/// Basins of the clearance landscape as a union-find over hilltops.
class Basins {
 public:
  Basins(const GridFrame& frame, const std::vector<float>& height, double saddle_ratio)
      : frame_(frame), height_(height), saddle_ratio_(static_cast<float>(saddle_ratio)), label_(frame.size(), none) {}

  /// Cells by falling height, ties by index.
  void flood() {
    for (const std::size_t cell : by_decreasing_clearance(frame_, height_)) add(cell);
  }

  [[nodiscard]] int root_of(std::size_t cell) { return label_[cell] == none ? none : find(label_[cell]); }
  [[nodiscard]] std::size_t count() const { return parent_.size(); }
  [[nodiscard]] float top(int basin) const { return top_[static_cast<std::size_t>(basin)]; }

 private:
  void add(std::size_t cell) {
    const auto [i, j] = frame_.column_and_row(cell);
    std::array<int, 8> met{};
    int count = 0;
    int uphill = none;
    float uphill_height = -1.0F;
    int last_label = none, last_root = none;  // neighbours mostly bear one label
    bool one = true;
    for (int nj = std::max(j - 1, 0); nj <= std::min(j + 1, frame_.ny - 1); ++nj)
      for (int ni = std::max(i - 1, 0); ni <= std::min(i + 1, frame_.nx - 1); ++ni) {
        const std::size_t n = frame_.index(ni, nj);
        if (n == cell || label_[n] == none) continue;
        const int root = label_[n] == last_label ? last_root : find(label_[n]);
        one = one && (last_root == none || root == last_root);
        last_label = label_[n];
        last_root = root;
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
    if (one) return;
    for (int m = 0; m < count; ++m) merge_basins(uphill, met[static_cast<std::size_t>(m)], height_[cell]);
  }

  void merge_basins(int a, int b, float pass) {
    a = find(a);
    b = find(b);
    if (a == b) return;
    // The older hilltop is the higher one, since cells come by falling height.
    const int high = std::min(a, b), low = std::max(a, b);
    if (pass >= saddle_ratio_ * top(low)) parent_[static_cast<std::size_t>(low)] = high;
  }

  int find(int a) {
    while (parent_[static_cast<std::size_t>(a)] != a) a = parent_[static_cast<std::size_t>(a)];
    return a;
  }

  const GridFrame& frame_;
  const std::vector<float>& height_;
  float saddle_ratio_;
  std::vector<int> label_;
  std::vector<int> parent_;
  std::vector<float> top_;
};

void find_boundary(const GridFrame& frame, const std::vector<int>& owner, int id, Cluster& cluster,
                   const std::vector<CellRun>& runs) {
  const auto width = static_cast<std::size_t>(frame.nx);
  for (const CellRun& run : runs) {
    const bool edge_row = run.j == 0 || run.j + 1 == frame.ny;
    int i = run.i;
    for (std::size_t k = run.from; k < run.to; ++k, ++i) {
      const std::size_t cell = cluster.cells[k];
      const bool inside = !edge_row && i > 0 && i + 1 < frame.nx && owner[cell - 1] == id && owner[cell + 1] == id &&
                          owner[cell - width] == id && owner[cell + width] == id;
      if (!inside) cluster.boundary.push_back(cell);
    }
  }
}

/// From its cells.
void measure(const GridFrame& frame, const std::vector<int>& owner, int id, Cluster& cluster) {
  const std::vector<CellRun> runs = runs_of(frame, cluster.cells);
  cluster.area_m2 = static_cast<double>(cluster.cells.size()) * frame.cell * frame.cell;
  for (const CellRun& run : runs)
    for (std::size_t k = run.from; k < run.to; ++k)
      cluster.center_M += frame.center(run.i + static_cast<int>(k - run.from), run.j);
  cluster.center_M /= static_cast<double>(cluster.cells.size());
  find_boundary(frame, owner, id, cluster, runs);
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

std::vector<Cluster> cut_by_watershed(const FreeGrid& grid, const std::vector<float>& height,
                                      const ClusterConfig& config) {
  Basins basins(grid.frame, height, config.saddle_ratio);
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

std::vector<CellRun> runs_of(const GridFrame& frame, const std::vector<std::size_t>& cells) {
  std::vector<CellRun> runs;
  std::size_t row_end = 0;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const bool goes_on = k > 0 && cells[k] == cells[k - 1] + 1 && cells[k] < row_end;
    if (!goes_on) {
      const auto [i, j] = frame.column_and_row(cells[k]);
      runs.push_back({k, k, i, j});
      row_end = frame.index(0, j + 1);
    }
    runs.back().to = k + 1;
  }
  return runs;
}

Cluster cluster_of(const FreeGrid& grid, std::vector<std::size_t> cells) {
  std::vector<int> owner(grid.frame.size(), none);
  for (const std::size_t cell : cells) owner[cell] = 0;
  Cluster cluster;
  cluster.cells = std::move(cells);
  measure(grid.frame, owner, 0, cluster);
  return cluster;
}

std::vector<float> distance_transform(const FreeGrid& grid) {
  const GridFrame& f = grid.frame;
  const auto width = static_cast<std::size_t>(f.nx);
  std::vector<float> d(f.size(), 0.0F);
  // Along the columns, row by row: cells to the nearest one that is not free, above and then below as well.
  std::vector<float> away(width, far);
  for (std::size_t k = 0, i = 0; k < f.size(); ++k, i = i + 1 == width ? 0 : i + 1)
    d[k] = away[i] = grid.free[k] != 0 ? away[i] + 1.0F : 0.0F;
  std::fill(away.begin(), away.end(), far);
  for (std::size_t k = f.size(), i = 0; k-- > 0;) {
    i = i == 0 ? width - 1 : i - 1;
    away[i] = grid.free[k] != 0 ? away[i] + 1.0F : 0.0F;
    const float nearest = std::min(d[k], away[i]);
    d[k] = nearest < far ? nearest * nearest : LineTransform::infinity;
  }
  // Along the rows, stretch by stretch: nothing behind the cells that are not free beside a stretch is nearer than
  // they.
  LineTransform row(f.nx);
  for (int j = 0; j < f.ny; ++j) {
    const std::size_t first = f.index(0, j), end = first + width;
    for (std::size_t from = first; from < end;) {
      if (grid.free[from] == 0) {
        ++from;
        continue;
      }
      std::size_t to = from;
      while (to < end && grid.free[to] != 0) ++to;
      row.run({d.data() + from - (from > first ? 1 : 0), d.data() + to + (to < end ? 1 : 0)});
      const std::vector<float>& out = row.out();
      for (std::size_t k = from; k < to; ++k)
        d[k] = static_cast<float>(f.cell) * std::sqrt(out[k - from + (from > first ? 1 : 0)]);
      from = to;
    }
  }
  return d;
}

std::vector<std::size_t> by_decreasing_clearance(const GridFrame& frame, const std::vector<float>& clearance_m) {
  // Squares of distances between cells are whole numbers of cells, so counting sorts them.
  const double scale = 1.0 / (frame.cell * frame.cell);
  std::vector<std::uint32_t> levels(clearance_m.size());
  std::vector<std::size_t> start;
  for (std::size_t k = 0; k < clearance_m.size(); ++k) {
    if (clearance_m[k] == 0.0F) continue;
    const auto h = static_cast<double>(clearance_m[k]);
    levels[k] = static_cast<std::uint32_t>(h * h * scale + 0.5);
    if (levels[k] >= start.size()) start.resize(levels[k] + 1, 0);
    ++start[levels[k]];
  }
  std::size_t above = 0;
  for (std::size_t l = start.size(); l-- > 1;) {
    const std::size_t count = start[l];
    start[l] = above;
    above += count;
  }
  std::vector<std::size_t> order(above);
  for (std::size_t k = 0; k < levels.size(); ++k)
    if (levels[k] > 0) order[start[levels[k]]++] = k;
  return order;
}

std::vector<Cluster> clusters(const FreeGrid& grid, const ClusterConfig& config) {
  if (grid.frame.size() == 0) return {};
  const std::vector<float> height = distance_transform(grid);
  return config.cut == Cut::watershed ? cut_by_watershed(grid, height, config) : cut_at_threshold(grid, height, config);
}

}  // namespace plumbline::slam
