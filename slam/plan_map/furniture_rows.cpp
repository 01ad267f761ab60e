// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_map/furniture_rows.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "bim/model/hull.h"
#include "slam/plan_map/pose2.h"
#include "slam/plan_map/upright.h"
#include "slam/plan_map/wall_lines.h"

namespace plumbline::slam {

namespace {

/// An element as the upright prism around it; without an outline where it reaches into no height from z0 to z1.
bim::PlanSolid hull_of(const bim::BuildingMesh& mesh, const bim::MeshElement& element, double z0, double z1) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  bim::PlanSolid hull{element.id, element.storey, {}, infinite, -infinite, true};
  for (int i = element.first_triangle; i < element.first_triangle + element.triangle_count; ++i)
    for (const int vertex : mesh.triangles[static_cast<std::size_t>(i)]) {
      const Eigen::Vector3d& p = mesh.vertices[static_cast<std::size_t>(vertex)];
      hull.outline.emplace_back(p.head<2>());
      hull.z0 = std::min(hull.z0, p.z());
      hull.z1 = std::max(hull.z1, p.z());
    }
  if (hull.z0 >= z1 || hull.z1 <= z0) return {};
  hull.outline = bim::convex_hull(std::move(hull.outline));
  return hull;
}

}  // namespace

std::vector<WallLine> furniture_rows(const bim::Plan& plan_W, const Pose& X_WI, double floor_z, double ceiling_z,
                                     const PlanIndexConfig& config) {
  const Pose2 X_IW = heading(X_WI).inverse();
  std::vector<PlanSegment> fronts;
  for (const bim::MeshElement& element : plan_W.furniture.elements) {
    const bim::PlanSolid hull = hull_of(plan_W.furniture, element, floor_z + X_WI.t.z(), ceiling_z + X_WI.t.z());
    for (PlanSegment& side : sides_of(hull, X_IW, X_WI.t.z())) {
      side.plan_face = 0;  // only faces make lines
      fronts.push_back(std::move(side));
    }
  }
  sort_by_geometry(fronts);
  PlanIndexConfig side_by_side = config;
  side_by_side.line_gap_m = config.row_gap_m;
  std::vector<WallLine> rows = merge_wall_lines(fronts, floor_z + config.wall_band_m, side_by_side);
  std::erase_if(rows, [&](const WallLine& row) { return row.length < config.row_min_m; });
  return rows;
}

}  // namespace plumbline::slam
