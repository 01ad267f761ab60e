// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "bim/geometry/plane.h"
#include "bim/plan/plan.h"
#include "slam/localization/as_printed/paper_switches.h"
#include "slam/plan_map/plan_index.h"
#include "slam/planes/forms.h"

namespace plumbline::slam {

/// A wall of the building as a landmark, in W.
struct PaperWall {
  int plan_face = -1;
  Plane plane_W;
  Eigen::Vector2d p0_W = Eigen::Vector2d::Zero();  ///< ends, free space on the left
  Eigen::Vector2d p1_W = Eigen::Vector2d::Zero();
};

/// A room with the walls a particle in it is matched against.
struct PaperRoom {
  Polygon2 polygon_W;
  Eigen::Vector2d low_W, high_W;     ///< its box along W's axes
  std::vector<int> walls;            ///< ascending
  std::vector<int> with_neighbours;  ///< also those of rooms reached through its doors, ascending
};

/// The two upper layers of an S-Graph of one storey, from the plan [shaheer2023, eq. 1-2].
struct PaperStorey {
  std::vector<PaperWall> walls;
  std::vector<PaperRoom> rooms;  ///< as StoreyIndex::rooms
  std::vector<int> all;          ///< every wall

  /// Room that holds p_W by box (printed) or polygon, or -1 (ties: lowest).
  [[nodiscard]] int room_at(const Eigen::Vector2d& p_W, PaperVariant outline) const;
};

/// faces: where the second face of a wall is taken to be.
[[nodiscard]] PaperStorey make_paper_storey(const bim::Plan& plan_W, const StoreyIndex& storey, double band_m,
                                            PaperVariant faces);

/// Minimal form of a plane for comparing. printed: closest point, whose normal points away from the origin.
[[nodiscard]] AnglePlane paper_form(const Plane& plane, PaperVariant form);
/// Of (azimuth, elevation, offset), observed less mapped [shaheer2023, eq. 7, 9].
[[nodiscard]] Eigen::Vector3d paper_difference(const AnglePlane& observed, const AnglePlane& mapped, PaperVariant wrap);

}  // namespace plumbline::slam
