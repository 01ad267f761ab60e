// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_map/likelihood_field.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "slam/plan_map/intervals.h"

namespace plumbline::slam {

namespace {

/// Stretches of [0, length] that no hole at height z takes away, ascending.
std::vector<Interval> standing_stretches(const PlanSegment& segment, double z) {
  std::vector<Interval> holes;
  for (const bim::FaceHole& hole : segment.holes)
    if (z > hole.z0 && z < hole.z1) holes.push_back({hole.s0, hole.s1});
  return rest_of(0.0, segment.length, std::move(holes));
}

}  // namespace

std::vector<SlicePiece> cut_plan(const StoreyIndex& storey, double height_m) {
  const double z = storey.floor_z + height_m;
  std::vector<SlicePiece> pieces;
  for (const PlanSegment& segment : storey.segments) {
    if (z < segment.z0 || z > segment.z1) continue;
    for (const auto& [s0, s1] : standing_stretches(segment, z))
      pieces.push_back({segment.a + s0 * segment.e, segment.a + s1 * segment.e});
  }
  return pieces;
}

double distance_to(const SlicePiece& piece, const Eigen::Vector2d& p) {
  const Eigen::Vector2d ab = piece.b - piece.a;
  const double length2 = ab.squaredNorm();
  const double s = length2 > 0.0 ? std::clamp((p - piece.a).dot(ab) / length2, 0.0, 1.0) : 0.0;
  return (p - piece.a - s * ab).norm();
}

LikelihoodField::LikelihoodField(const StoreyIndex& storey, const LikelihoodFieldConfig& config)
    : cell_(config.cell_m), max_distance_(config.max_distance_m) {
  const std::vector<SlicePiece> pieces = cut_plan(storey, config.slice_height_m);
  std::vector<Eigen::Vector2d> points;
  for (const IndexRoom& room : storey.rooms) points.insert(points.end(), room.polygon.begin(), room.polygon.end());
  for (const SlicePiece& piece : pieces) points.insert(points.end(), {piece.a, piece.b});
  Eigen::Vector2d low = points.empty() ? Eigen::Vector2d::Zero() : points.front(), high = low;
  for (const Eigen::Vector2d& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Eigen::Vector2d size = (high - low).array() + 2.0 * max_distance_;
  while (std::ceil(size.x() / cell_) * std::ceil(size.y() / cell_) > config.max_cells) cell_ *= 2.0;
  origin_ = low.array() - max_distance_;
  nx_ = static_cast<int>(std::ceil(size.x() / cell_));
  ny_ = static_cast<int>(std::ceil(size.y() / cell_));
  distance_.assign(static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_), static_cast<float>(max_distance_));
  for (const SlicePiece& piece : pieces) add(piece);
  find_free_cells(storey);
}

void LikelihoodField::add(const SlicePiece& piece) {
  const Eigen::Vector2d low = piece.a.cwiseMin(piece.b).array() - max_distance_;
  const Eigen::Vector2d high = piece.a.cwiseMax(piece.b).array() + max_distance_;
  const auto cell_of = [&](double value, double origin, int count) {
    return std::clamp(static_cast<int>(std::floor((value - origin) / cell_)), 0, count - 1);
  };
  const int x0 = cell_of(low.x(), origin_.x(), nx_), x1 = cell_of(high.x(), origin_.x(), nx_);
  const int y0 = cell_of(low.y(), origin_.y(), ny_), y1 = cell_of(high.y(), origin_.y(), ny_);
  for (int y = y0; y <= y1; ++y) {
    float* row = distance_.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(nx_);
    for (int x = x0; x <= x1; ++x) {
      const Eigen::Vector2d p = origin_ + cell_ * Eigen::Vector2d(x + 0.5, y + 0.5);
      row[x] = std::min(row[x], static_cast<float>(distance_to(piece, p)));
    }
  }
}

void LikelihoodField::find_free_cells(const StoreyIndex& storey) {
  for (int y = 0; y < ny_; ++y)
    for (int x = 0; x < nx_; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(nx_) + static_cast<std::size_t>(x);
      if (distance_[i] < 0.75 * cell_) continue;  // half of a cell's diagonal, and a little
      const Eigen::Vector2d p = origin_ + cell_ * Eigen::Vector2d(x + 0.5, y + 0.5);
      if (storey.room_at(p) >= 0) free_cells_.push_back(p.cast<float>());
    }
}

}  // namespace plumbline::slam
