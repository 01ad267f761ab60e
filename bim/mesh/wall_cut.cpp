// SPDX-License-Identifier: Apache-2.0
#include "bim/mesh/wall_cut.h"

#include <algorithm>
#include <utility>

#include "bim/geometry/polygon_boolean.h"
#include "bim/mesh/boolean.h"
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

/// The same opening as its outline in the wall's elevation, as deep as it is: for a body that does not close.
std::optional<Solid> outline_cutter(const Opening& opening, const WallFrame& frame, const Interval& y,
                                    const MeshConfig& config) {
  const std::vector<Solid> solids = solids_of(opening);
  Region2 outline = unite(projected(frame, solids));
  if (outline.empty()) outline = unite(std::vector<Polygon2>{rectangle_of(opening)});
  if (outline.empty()) return std::nullopt;
  Interval depth = extent_across(frame, solids);
  if (depth.length() <= config.depth_m) depth = y;
  return overhanging(through_cutter(outline, frame, depth, config), frame, y, config);
}

/// Sides of the openings through a wall whose body has no inside: what one sees in them.
void add_reveals(Solid& surface, const std::vector<BooleanStep>& steps, const Interval& y, const MeshConfig& config) {
  for (const BooleanStep& step : steps) {
    Solid inner = step.other;
    for (Eigen::Vector3d& p : inner.vertices) p.y() = std::clamp(p.y(), y.low, y.high);
    for (const Eigen::Vector3i& t : inner.triangles) {
      const auto at = [&](int k) { return inner.vertices[static_cast<std::size_t>(t[k])]; };
      const Interval across = [&] {
        Interval range;
        for (int k = 0; k < 3; ++k) range.add(at(k).y());
        return range;
      }();
      if (across.length() <= config.face_m) continue;  // on a face of the wall
      const int first = static_cast<int>(surface.vertices.size());
      surface.vertices.insert(surface.vertices.end(), {at(0), at(2), at(1)});
      surface.triangles.emplace_back(first, first + 1, first + 2);
    }
  }
}

/// In the wall's own frame, where its faces lie square to the grid however the wall is turned.
CutWall cut_in_space(const Wall& wall, const std::vector<Opening>& openings, const MeshConfig& config) {
  const WallFrame frame(wall);
  const Interval y = thickness_of(wall, frame);
  CutWall cut;
  std::vector<BooleanStep> steps;
  for (const Opening& opening : openings) {
    for (const Solid& part : cutters_of(opening, frame, y, config)) {
      std::optional<Solid> cutter = repaired(in_wall(part, frame), config.weld_m);
      if (!cutter)
        if (const std::optional<Solid> outline = outline_cutter(opening, frame, y, config))
          cutter = repaired(in_wall(*outline, frame), config.weld_m);
      if (cutter)
        steps.push_back({BooleanOperation::difference, std::move(*cutter)});
      else
        cut.warnings.push_back({wall.id, "not_cut", "opening '" + opening.id + "' could not be cut out"});
    }
  }
  BooleanResult rest = boolean_steps(in_wall(whole_body(wall, config), frame), steps, config.weld_m);
  cut.closed = rest.closed;
  if (!cut.closed) {
    cut.warnings.push_back({wall.id, "not_closed", "the body's surface does not close"});
    add_reveals(rest.solid, steps, y, config);
    rest.solid = welded(rest.solid, config.weld_m);
  }
  cut.solid = canonical(in_world(rest.solid, frame), config.grid_m);
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
