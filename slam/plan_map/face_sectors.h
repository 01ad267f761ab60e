// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "slam/plan_map/float4.h"
#include "slam/plan_map/ray_candidates.h"

namespace plumbline::slam {

/// RayCandidateTable for packets of rays: for each cell and each four sectors side by side, the faces that a ray may
/// hit, nearest first.
class FaceSectors {
 public:
  static constexpr int per_turn = 24;
  static constexpr int wide = 4;

  // Every number four times, for the intersection with four rays.
  /// A hole of a face, or the face itself: along it and in height, m.
  struct Window {
    Float4 s0, s1, z0, z1;
  };
  struct Face {
    Float4 nx, ny, ex, ey, ax, ay;  ///< normal, direction, start
    Window whole;
    int first_hole = 0, last_hole = 0;  ///< of all faces' holes
  };
  /// As RayCandidateTable::Entry, but the last of a list has the least distance up to which one of its rays is
  /// complete.
  using Entry = RayCandidateTable::Entry;

  /// Where four rays hit a face.
  struct Intersection {
    Mask4 hit;      ///< outside of its holes, nearer than what is to be beaten
    Float4 t;       ///< distance of its plane, m
    Float4 across;  ///< cosine between ray and normal
  };

  FaceSectors() = default;
  /// Empty where ray_candidates is.
  FaceSectors(const std::vector<PlanSegment>& segments, const RayCandidateTable& ray_candidates, int cells);

  [[nodiscard]] bool empty() const { return first_.empty(); }
  /// The list for directions from 2 pi sector / per_turn on, over `wide` sectors.
  [[nodiscard]] const Entry* list(int cell, int sector) const {
    return &entries_[static_cast<std::size_t>(first_[static_cast<std::size_t>(cell * per_turn + sector)])];
  }
  /// Up to which distance the list is complete for rays of this direction.
  [[nodiscard]] float complete(int cell, const Eigen::Vector2d& direction) const {
    return complete_[static_cast<std::size_t>(cell * RayCandidateTable::azimuth_bins_per_turn +
                                              RayCandidateTable::azimuth_bin_of(direction))];
  }
  [[nodiscard]] const Face& face(int segment) const { return faces_[static_cast<std::size_t>(segment)]; }
  /// (x, y): unit directions; all start at (px, py), height z.
  [[nodiscard]] Intersection intersect(const Face& face, Float4 px, Float4 py, float z, Float4 x, Float4 y,
                                       Float4 slope, Float4 nearest) const {
    const Float4 ax = face.ax - px, ay = face.ay - py;
    const Float4 across = face.nx * x + face.ny * y;
    const Float4 t = (face.nx * ax + face.ny * ay) / across;
    const Float4 s = t * (face.ex * x + face.ey * y) - (face.ex * ax + face.ey * ay);
    const Float4 height = z + t * slope;
    Mask4 hit = (t > 1e-9F) & (t < nearest) & (s >= 0.0F) & (s <= face.whole.s1) & (height >= face.whole.z0) &
                (height <= face.whole.z1);
    for (int i = face.first_hole; i < face.last_hole && lanes(hit) != 0; ++i) {
      const Window& hole = holes_[static_cast<std::size_t>(i)];
      hit &= ~((s > hole.s0) & (s < hole.s1) & (height > hole.z0) & (height < hole.z1));
    }
    return {hit, t, across};
  }

 private:
  std::vector<Face> faces_;
  std::vector<Window> holes_;
  std::vector<int> first_;  ///< by cell and sector: start of its list
  std::vector<Entry> entries_;
  std::vector<float> complete_;  ///< by cell and azimuth bin of RayCandidateTable
};

}  // namespace plumbline::slam
