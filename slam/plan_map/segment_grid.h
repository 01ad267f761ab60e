// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "slam/plan_map/plan_segment.h"
#include "slam/plan_map/ray_candidates.h"

namespace plumbline::slam {

/// Segments of one storey in a uniform grid, for first hits of rays. Faces block from both sides, because a ray that
/// enters a door obliquely ends on the back of the other face, where the jamb is.
class SegmentGrid {
 public:
  SegmentGrid() = default;
  /// Covers all segments with a margin of one cell. Cells are doubled until they are no more than RayCandidateTable
  /// takes.
  SegmentGrid(const std::vector<PlanSegment>& segments, double cell_m);

  /// First face hit outside its holes; of faces at equal distance the lowest index.
  [[nodiscard]] PlanHit cast(const std::vector<PlanSegment>& segments, const PlanRay& ray, double max_distance) const {
    return cast(segments, ray, max_distance, cell_at(ray.origin));
  }
  /// The same, for many rays from one cell.
  [[nodiscard]] PlanHit cast(const std::vector<PlanSegment>& segments, const PlanRay& ray, double max_distance,
                             int cell) const {
    PlanHit best{max_distance, -1};
    return cell >= 0 && ray_candidates_.cast(segments, cell, ray, best) ? best : search(segments, ray, max_distance);
  }
  /// Whether the ray passes through a hole of a face between two horizontal distances.
  [[nodiscard]] bool crosses_opening(const std::vector<PlanSegment>& segments, const PlanRay& ray, double from,
                                     double to) const {
    return crosses_opening(segments, ray, from, to, cell_at(ray.origin));
  }
  [[nodiscard]] bool crosses_opening(const std::vector<PlanSegment>& segments, const PlanRay& ray, double from,
                                     double to, int cell) const;
  /// Index of the cell with p, or -1 outside of the grid.
  [[nodiscard]] int cell_at(const Eigen::Vector2d& p) const {
    const std::optional<std::size_t> cell = frame_.find(p);
    return cell ? static_cast<int>(*cell) : -1;
  }
  /// Distance before which no ray from a cell hits a face.
  [[nodiscard]] double clearance(int cell) const { return clearance_[static_cast<std::size_t>(cell)]; }
  [[nodiscard]] int cells() const { return static_cast<int>(frame_.size()); }
  [[nodiscard]] Eigen::Vector2d cell_center(int cell) const { return frame_.center(static_cast<std::size_t>(cell)); }
  [[nodiscard]] const RayCandidateTable& ray_candidates() const { return ray_candidates_; }
  [[nodiscard]] double cell_size() const { return frame_.cell; }

 private:
  /// Calls visit(index) for the faces listed in the cells along the ray; it returns how far still to go.
  template <class Visit>
  void march(const PlanRay& ray, Visit visit, double reach) const;
  /// As cast, cell by cell along the ray.
  [[nodiscard]] PlanHit search(const std::vector<PlanSegment>& segments, const PlanRay& ray, double max_distance) const;
  void fill(const std::vector<PlanSegment>& segments);

  GridFrame frame_;
  std::vector<int> first_;  ///< per cell: start of its list in items_
  std::vector<int> items_;
  RayCandidateTable ray_candidates_;
  std::vector<double> clearance_;  ///< per cell
};

}  // namespace plumbline::slam
