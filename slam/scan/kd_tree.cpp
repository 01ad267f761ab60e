// SPDX-License-Identifier: Apache-2.0
#include "slam/scan/kd_tree.h"

#include <nanoflann.hpp>
#include <utility>

namespace plumbline::slam {

namespace {

/// Adaptor of a cloud to nanoflann.
struct Cloud {
  std::vector<Eigen::Vector3d> points;
  [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
  [[nodiscard]] double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return points[i][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};
using Tree3 = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, 3, std::size_t>;

}  // namespace

struct KdTree::Impl {
  Cloud cloud;
  Tree3 tree;
  std::vector<std::size_t> indices;
  std::vector<double> distances2;
  std::vector<Neighbour> found;

  explicit Impl(std::vector<Eigen::Vector3d> points)
      : cloud{std::move(points)}, tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(10)) {}
};

KdTree::KdTree(std::vector<Eigen::Vector3d> points) : impl_(std::make_unique<Impl>(std::move(points))) {}
KdTree::~KdTree() = default;
KdTree::KdTree(KdTree&&) noexcept = default;
KdTree& KdTree::operator=(KdTree&&) noexcept = default;

const std::vector<Eigen::Vector3d>& KdTree::points() const { return impl_->cloud.points; }

std::span<const Neighbour> KdTree::nearest(const Eigen::Vector3d& p, std::size_t count) const {
  Impl& impl = *impl_;
  impl.found.clear();
  if (impl.cloud.points.empty() || count == 0) return {};
  impl.indices.resize(count);
  impl.distances2.resize(count);
  const std::size_t n = impl.tree.knnSearch(p.data(), count, impl.indices.data(), impl.distances2.data());
  for (std::size_t k = 0; k < n; ++k) impl.found.push_back({impl.indices[k], impl.distances2[k]});
  return impl.found;
}

}  // namespace plumbline::slam
