// SPDX-License-Identifier: Apache-2.0
#include "bim/mesh/wall_cut.h"

#include <algorithm>
#include <utility>

#include "bim/geometry/polygon_boolean.h"
#include "bim/mesh/corefine.h"
#include "bim/mesh/solid.h"
#include "bim/model/extrude.h"
#include "bim/model/wall_frame.h"

namespace plumbline::bim {

namespace {

/// Extent of the wall across its reference line.
Interval thickness_of(const Wall& wall, const WallFrame& frame) {
  if (wall.body && !wall.body->vertices.empty()) return extent_across(frame, {*wall.body});
  return {wall.offset_m, wall.offset_m + wall.thickness_m};
}

/// Cutter through the whole wall with the given outline in its elevation.
Solid through_cutter(const Region2& outline, const WallFrame& frame, const Interval& y, const MeshConfig& config) {
  return extrude_between(
      outline,
      [&](const Eigen::Vector2d& p) {
        return frame.to_world({p.x(), y.high + config.margin_m, p.y()});
      },
      [&](const Eigen::Vector2d& p) {
        return frame.to_world({p.x(), y.low - config.margin_m, p.y()});
      });
}

Polygon2 rectangle_of(const Opening& opening) {
  const double x0 = opening.s_m - 0.5 * opening.width_m, x1 = opening.s_m + 0.5 * opening.width_m;
  return {{x0, opening.z0_m}, {x1, opening.z0_m}, {x1, opening.z1_m}, {x0, opening.z1_m}};
}

/// Pushes what ends at a face of the wall out of it: rounding would otherwise leave a film across the opening.
Solid overhanging(Solid cutter, const WallFrame& frame, const Interval& y, const MeshConfig& config) {
  for (Eigen::Vector3d& p_W : cutter.vertices) {
    Eigen::Vector3d p = frame.to_wall(p_W);
    if (p.y() <= y.low + config.depth_m) p.y() = std::min(p.y(), y.low - config.margin_m);
    if (p.y() >= y.high - config.depth_m) p.y() = std::max(p.y(), y.high + config.margin_m);
    p_W = frame.to_world(p);
  }
  return cutter;
}

std::vector<Solid> cutters_of(const Opening& opening, const WallFrame& frame, const Interval& y,
                              const MeshConfig& config) {
  std::vector<Solid> cutters = solids_of(opening);
  if (cutters.empty()) return {through_cutter(unite(std::vector<Polygon2>{rectangle_of(opening)}), frame, y, config)};
  const Interval depth = extent_across(frame, cutters);
  const bool through = depth.low <= y.low + config.depth_m && depth.high >= y.high - config.depth_m;
  // Touching parts cut one by one would leave a film where they meet.
  if (through && cutters.size() > 1) return {through_cutter(unite(projected(frame, cutters)), frame, y, config)};
  for (Solid& cutter : cutters) cutter = overhanging(std::move(cutter), frame, y, config);
  return cutters;
}

/// The uncut body of a wall as one solid.
Solid whole_body(const Wall& wall, const MeshConfig& config) {
  return wall.body ? *wall.body : std::get<Solid>(cut_in_elevation(wall, {}, config));
}

Solid in_wall(Solid solid, const WallFrame& frame) {
  for (Eigen::Vector3d& p : solid.vertices) p = frame.to_wall(p);
  return solid;
}

Solid in_world(Solid solid, const WallFrame& frame) {
  for (Eigen::Vector3d& p : solid.vertices) p = frame.to_world(p);
  return solid;
}

/// In the wall's own frame, where its faces lie square to the grid however the wall is turned.
CutWall cut_in_space(const Wall& wall, const std::vector<Opening>& openings, const MeshConfig& config) {
  const WallFrame frame(wall);
  const Interval y = thickness_of(wall, frame);
  CutWall cut;
  const Solid whole = whole_body(wall, config);
  std::optional<Solid> body = repaired(in_wall(whole, frame), config.weld_m);
  cut.closed = body.has_value();
  if (!body) {
    cut.warnings.push_back({wall.id, "not_closed", "the body's surface does not close; openings are not cut"});
    cut.solid = canonical(welded(whole, config.weld_m), config.grid_m);
    return cut;
  }
  for (const Opening& opening : openings) {
    for (const Solid& part : cutters_of(opening, frame, y, config)) {
      const std::optional<Solid> cutter = repaired(in_wall(part, frame), config.weld_m);
      std::optional<Solid> rest = cutter ? difference(*body, *cutter, config.weld_m) : std::nullopt;
      if (rest)
        body = std::move(rest);
      else
        cut.warnings.push_back({wall.id, "not_cut", "opening '" + opening.id + "' could not be cut out"});
    }
  }
  cut.solid = canonical(in_world(*body, frame), config.grid_m);
  return cut;
}

}  // namespace

CutWall cut_wall(const Wall& wall, const std::vector<Opening>& openings, const MeshConfig& config) {
  const std::variant<Solid, Refusal> flat = cut_in_elevation(wall, openings, config);
  if (std::holds_alternative<Solid>(flat)) {
    CutWall cut{canonical(std::get<Solid>(flat), config.grid_m), true, {}};
    if (cut.solid.triangles.empty()) cut.warnings.push_back({wall.id, "empty", "its openings leave nothing of it"});
    return cut;
  }
  const Refusal& refusal = std::get<Refusal>(flat);
  CutWall cut = cut_in_space(wall, openings, config);
  cut.warnings.insert(cut.warnings.begin(), {wall.id, refusal.kind, refusal.text + "; cut in 3D"});
  return cut;
}

}  // namespace plumbline::bim
