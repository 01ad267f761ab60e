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
    : max_distance_(config.max_distance_m) {
  const std::vector<SlicePiece> pieces = cut_plan(storey, config.slice_height_m);
  std::vector<Eigen::Vector2d> points;
  for (const LocalRoom& room : storey.rooms) points.insert(points.end(), room.polygon.begin(), room.polygon.end());
  for (const SlicePiece& piece : pieces) points.insert(points.end(), {piece.a, piece.b});
  Eigen::Vector2d low = points.empty() ? Eigen::Vector2d::Zero() : points.front(), high = low;
  for (const Eigen::Vector2d& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Eigen::Vector2d size = (high - low).array() + 2.0 * max_distance_;
  double cell = config.cell_m;
  while (std::ceil(size.x() / cell) * std::ceil(size.y() / cell) > config.max_cells) cell *= 2.0;
  frame_ = {low.array() - max_distance_, cell, static_cast<int>(std::ceil(size.x() / cell)),
            static_cast<int>(std::ceil(size.y() / cell))};
  distance_.assign(frame_.size(), static_cast<float>(max_distance_));
  for (const SlicePiece& piece : pieces) add(piece);
  find_free_cells(storey);
}

void LikelihoodField::add(const SlicePiece& piece) {
  const Eigen::Vector2d low = piece.a.cwiseMin(piece.b).array() - max_distance_;
  const Eigen::Vector2d high = piece.a.cwiseMax(piece.b).array() + max_distance_;
  const auto inside = [](int cell, int count) { return std::clamp(cell, 0, count - 1); };
  const int x0 = inside(frame_.column(low.x()), frame_.nx), x1 = inside(frame_.column(high.x()), frame_.nx);
  const int y0 = inside(frame_.row(low.y()), frame_.ny), y1 = inside(frame_.row(high.y()), frame_.ny);
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      float& nearest = distance_[frame_.index(x, y)];
      nearest = std::min(nearest, static_cast<float>(distance_to(piece, frame_.center(x, y))));
    }
}

void LikelihoodField::find_free_cells(const StoreyIndex& storey) {
  for (int y = 0; y < frame_.ny; ++y)
    for (int x = 0; x < frame_.nx; ++x) {
      if (distance_[frame_.index(x, y)] < 0.75 * frame_.cell) continue;  // half of a cell's diagonal, and a little
      const Eigen::Vector2d p = frame_.center(x, y);
      if (storey.room_at(p) >= 0) free_cells_.push_back(p.cast<float>());
    }
}

}  // namespace plumbline::slam
