// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/ukf/grid_match.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

namespace plumbline::slam {

bool GridMatch::before(const GridMatch& other) const {
  return std::make_tuple(-score, turn, y, x) < std::make_tuple(-other.score, other.turn, other.y, other.x);
}

GridMatcher::GridMatcher(const StoreyIndex& storey, double slice_height_m, const GridMatchConfig& config)
    : config_(config) {
  const LikelihoodField field(storey, {.cell_m = config.cell_m,
                                       .max_distance_m = 4.0 * config.sigma_m,
                                       .slice_height_m = slice_height_m,
                                       .max_cells = config.max_cells});
  frame_ = field.frame();
  Level fine{0, frame_.nx, frame_.ny, {}};
  for (int y = 0; y < frame_.ny; ++y)
    for (int x = 0; x < frame_.nx; ++x) {
      const double z = field.at(frame_.center(x, y)) / config.sigma_m;
      fine.values.push_back(static_cast<std::uint8_t>(std::lround(255.0 * std::exp(-0.5 * z * z))));
    }
  levels_.push_back(std::move(fine));
  for (int l = 1; l < config.levels; ++l) {
    // A window is four of the level below, half its side apart.
    const Level& below = levels_.back();
    const int half = 1 << (l - 1);
    Level level{2 * half - 1, frame_.nx + 2 * half - 1, frame_.ny + 2 * half - 1, {}};
    for (int y = -level.pad; y < frame_.ny; ++y)
      for (int x = -level.pad; x < frame_.nx; ++x)
        level.values.push_back(static_cast<std::uint8_t>(
            std::max({below.at(x, y), below.at(x + half, y), below.at(x, y + half), below.at(x + half, y + half)})));
    levels_.push_back(std::move(level));
  }
}

std::vector<double> GridMatcher::yaws(double middle, double half_width) const {
  const double ratio = frame_.cell / config_.max_range_m;
  const double step = std::acos(1.0 - 0.5 * ratio * ratio);
  const int count = std::max(1, static_cast<int>(std::ceil(2.0 * half_width / step)));
  std::vector<double> yaws;
  for (int k = 0; k < count; ++k)
    yaws.push_back(wrap_angle(middle - half_width + (k + 0.5) * 2.0 * half_width / count));
  return yaws;
}

GridMatcher::Cells GridMatcher::cells_of(std::span<const Eigen::Vector2d> points, double yaw) const {
  const Eigen::Matrix2d R = Pose2{{}, yaw}.rotation();
  Cells cells;
  for (const Eigen::Vector2d& p : points) {
    if (!(p.norm() <= config_.max_range_m)) continue;
    const Eigen::Vector2d q = R * p / frame_.cell;
    cells.emplace_back(static_cast<int>(std::lround(q.x())), static_cast<int>(std::lround(q.y())));
  }
  return cells;
}

GridMatch GridMatcher::bound_of(const Cells& cells, int turn, int level, int x, int y) const {
  const Level& values = levels_[static_cast<std::size_t>(level)];
  GridMatch match{0, turn, x, y, true};
  for (const Eigen::Vector2i& cell : cells) match.score += values.at(x + cell.x(), y + cell.y());
  return match;
}

int GridMatcher::score(std::span<const Eigen::Vector2d> points, double yaw, int x, int y) const {
  return bound_of(cells_of(points, yaw), 0, 0, x, y).score;
}

/// Depth first, the more promising child before the others. A block can hold no better match than its bound, at no
/// lower key than its own.
void GridMatcher::descend(const Node& node, const std::vector<Cells>& cells, GridMatch& best, int& nodes) const {
  if (!node.bound.before(best) || nodes >= config_.max_nodes) return;
  if (node.level == 0) {
    best = node.bound;
    return;
  }
  const int half = 1 << (node.level - 1);
  std::vector<Node> children;
  for (int k = 0; k < 4; ++k) {
    const int x = node.bound.x + (k % 2) * half, y = node.bound.y + (k / 2) * half;
    if (x >= frame_.nx || y >= frame_.ny) continue;
    const int turn = node.bound.turn;
    children.push_back({bound_of(cells[static_cast<std::size_t>(turn)], turn, node.level - 1, x, y), node.level - 1});
    ++nodes;
  }
  std::sort(children.begin(), children.end(), [](const Node& a, const Node& b) { return a.bound.before(b.bound); });
  for (const Node& child : children) descend(child, cells, best, nodes);
}

GridMatch GridMatcher::best(std::span<const Eigen::Vector2d> points, std::span<const double> yaws) const {
  std::vector<Cells> cells;
  for (const double yaw : yaws) cells.push_back(cells_of(points, yaw));
  const int top = static_cast<int>(levels_.size()) - 1, block = 1 << top;
  std::vector<Node> roots;
  for (std::size_t t = 0; t < cells.size(); ++t)
    for (int y = 0; y < frame_.ny; y += block)
      for (int x = 0; x < frame_.nx; x += block)
        roots.push_back({bound_of(cells[t], static_cast<int>(t), top, x, y), top});
  std::sort(roots.begin(), roots.end(), [](const Node& a, const Node& b) { return a.bound.before(b.bound); });
  GridMatch best;
  int nodes = 0;
  for (const Node& root : roots) descend(root, cells, best, nodes);
  best.complete = nodes < config_.max_nodes;
  return best;
}

Pose2 GridMatcher::pose(const GridMatch& match, std::span<const double> yaws) const {
  return {frame_.center(0, 0) + frame_.cell * Eigen::Vector2d(match.x, match.y),
          yaws[static_cast<std::size_t>(match.turn)]};
}

}  // namespace plumbline::slam
