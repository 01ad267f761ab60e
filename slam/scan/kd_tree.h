// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace plumbline::slam {

/// A neighbour of a point: its index, and the squared distance, m^2.
struct Neighbour {
  std::size_t index = 0;
  double distance2 = 0.0;
};

/// Points by place. Exact; among equals the tree's order decides, which is the same in each run.
class KdTree {
 public:
  explicit KdTree(std::vector<Eigen::Vector3d> points);
  ~KdTree();
  KdTree(KdTree&&) noexcept;
  KdTree& operator=(KdTree&&) noexcept;

  [[nodiscard]] const std::vector<Eigen::Vector3d>& points() const;
  /// The `count` nearest points, or all where there are fewer, nearest first. The list is good until the next call.
  [[nodiscard]] std::span<const Neighbour> nearest(const Eigen::Vector3d& p, std::size_t count) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumbline::slam
