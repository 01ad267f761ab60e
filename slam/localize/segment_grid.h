// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "bim/building/plan.h"

namespace plumbline::slam {

/// A wall face, or a side of a column or the like, as a vertical rectangle with holes, in the plan-fixed frame I.
struct PlanSegment {
  int plan_face = -1;  ///< index into Plan::faces, -1: side of a solid, which is no wall
  int line = -1;       ///< WallLine it is part of, -1: none
  Eigen::Vector2d a = Eigen::Vector2d::Zero();
  Eigen::Vector2d e = Eigen::Vector2d::UnitX();  ///< unit, along the face
  Eigen::Vector2d n = Eigen::Vector2d::UnitY();  ///< unit, into free space: left of e
  double length = 0.0;
  double z0 = 0.0, z1 = 3.0;
  std::vector<bim::FaceHole> holes;
};

/// A straight ray over the plan: horizontal direction and rise per horizontal metre.
struct PlanRay {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();  ///< unit
  double z = 0.0;
  double slope = 0.0;
};

struct PlanHit {
  double distance = 0.0;  ///< horizontal, m; max_distance when nothing is hit
  int segment = -1;       ///< -1: nothing
};

/// Segments of one storey in a uniform grid, for first hits of rays. Faces block from both sides, because a ray that
/// enters a door obliquely ends on the back of the other face, where the jamb is.
class SegmentGrid {
 public:
  SegmentGrid() = default;
  /// Covers all segments with a margin of one cell.
  SegmentGrid(const std::vector<PlanSegment>& segments, double cell_m);

  /// First face hit outside its holes; of faces at equal distance the lowest index.
  [[nodiscard]] PlanHit cast(const std::vector<PlanSegment>& segments, const PlanRay& ray, double max_distance) const;
  /// Whether the ray passes through a hole of a face between two horizontal distances.
  [[nodiscard]] bool crosses_opening(const std::vector<PlanSegment>& segments, const PlanRay& ray, double from,
                                     double to) const;
  /// Index of the cell with p, or -1 outside of the grid.
  [[nodiscard]] int cell_at(const Eigen::Vector2d& p) const;
  [[nodiscard]] int cells() const { return nx_ * ny_; }
  [[nodiscard]] Eigen::Vector2d cell_center(int cell) const;
  [[nodiscard]] double cell_size() const { return cell_; }

 private:
  /// Calls visit(index) for the faces listed in the cells along the ray; it returns how far still to go.
  template <class Visit>
  void march(const PlanRay& ray, Visit visit, double reach) const;
  void fill(const std::vector<PlanSegment>& segments);

  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
  double cell_ = 0.5;
  int nx_ = 0, ny_ = 0;
  std::vector<int> first_;  ///< per cell: start of its list in items_
  std::vector<int> items_;
};

}  // namespace plumbline::slam
