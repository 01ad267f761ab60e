// SPDX-License-Identifier: Apache-2.0
#include "bim/mesh/wall_cut.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "bim/geometry/polygon_boolean.h"
#include "bim/mesh/boolean.h"
#include "bim/mesh/corefine.h"
#include "bim/mesh/solid.h"
#include "bim/mesh/straight_opening.h"
#include "bim/model/extrude.h"
#include "bim/model/through.h"
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

Solid in_wall(Solid solid, const WallFrame& frame) {
  for (Eigen::Vector3d& p : solid.vertices) p = frame.to_wall(p);
  return solid;
}

Solid in_world(Solid solid, const WallFrame& frame) {
  for (Eigen::Vector3d& p : solid.vertices) p = frame.to_world(p);
  return solid;
}

/// Lengthens what ends at a face of the wall past it: rounding would otherwise leave a film across the opening. `side`
/// is -1 at the low face, 1 at the high one; points are in the wall's frame.
Solid lengthened(Solid cutter, double face, double side, const MeshConfig& config) {
  const double past = face + side * config.margin_m;
  const auto at_face = [&](int i) {
    return side * (cutter.vertices[static_cast<std::size_t>(i)].y() - face) >= -config.depth_m;
  };
  const auto ends_here = [&](int i) {
    return at_face(i) && side * (cutter.vertices[static_cast<std::size_t>(i)].y() - past) < 0.0;
  };
  // Moving the end of a side that is aslant would turn it: such a cutter goes on square to the face.
  const bool aslant = std::any_of(cutter.triangles.begin(), cutter.triangles.end(), [&](const Eigen::Vector3i& t) {
    if (!std::any_of(t.data(), t.data() + 3, ends_here) || std::all_of(t.data(), t.data() + 3, at_face)) return false;
    const auto p = [&](int k) { return cutter.vertices[static_cast<std::size_t>(t[k])]; };
    const Eigen::Vector3d n = (p(1) - p(0)).cross(p(2) - p(0));
    return std::abs(n.y()) * config.margin_m > config.weld_m * n.norm();
  });
  if (!aslant) {
    for (int i = 0; i < static_cast<int>(cutter.vertices.size()); ++i)
      if (ends_here(i)) cutter.vertices[static_cast<std::size_t>(i)].y() = past;
    return cutter;
  }
  std::map<int, int> beyond;  // the vertices of the end, once more past the face
  std::set<std::array<int, 2>> edges;
  const std::vector<Eigen::Vector3i> triangles = std::move(cutter.triangles);
  cutter.triangles.clear();
  for (const Eigen::Vector3i& t : triangles) {
    if (!std::all_of(t.data(), t.data() + 3, at_face)) {
      cutter.triangles.push_back(t);
      continue;
    }
    for (int k = 0; k < 3; ++k) {
      if (ends_here(t[k]) && !beyond.contains(t[k])) {
        beyond[t[k]] = static_cast<int>(cutter.vertices.size());
        const Eigen::Vector3d p = cutter.vertices[static_cast<std::size_t>(t[k])];
        cutter.vertices.emplace_back(p.x(), past, p.z());
      }
      edges.insert({t[k], t[(k + 1) % 3]});
    }
    cutter.triangles.push_back(t.unaryExpr([&](int i) { return beyond.contains(i) ? beyond.at(i) : i; }));
  }
  const auto add = [&](int a, int b, int c) {
    if (a != b && b != c && c != a) cutter.triangles.emplace_back(a, b, c);
  };
  for (const auto& [a, b] : edges) {
    if (edges.contains({b, a})) continue;
    const int a_past = beyond.contains(a) ? beyond.at(a) : a, b_past = beyond.contains(b) ? beyond.at(b) : b;
    add(a, b, b_past);
    add(a, b_past, a_past);
  }
  return cutter;
}

/// A cutter past both faces of the wall; in W, as it came.
Solid overhanging(Solid cutter, const WallFrame& frame, const Interval& y, const MeshConfig& config) {
  cutter = lengthened(lengthened(in_wall(std::move(cutter), frame), y.low, -1.0, config), y.high, 1.0, config);
  return in_world(std::move(cutter), frame);
}

std::vector<Solid> cutters_of(const Opening& opening, const WallFrame& frame, const Interval& y,
                              const MeshConfig& config) {
  std::vector<Solid> cutters = solids_of(opening);
  if (cutters.empty()) return {through_cutter(unite(std::vector<Polygon2>{rectangle_of(opening)}), frame, y, config)};
  // Touching parts cut one by one would leave a film where they meet.
  std::vector<Solid> straight, others;
  const bool together = goes_straight_through(cutters, frame, y, config);
  for (Solid& cutter : cutters)
    (together || goes_straight_through({cutter}, frame, y, config) ? straight : others).push_back(std::move(cutter));
  if (straight.size() > 1) straight = {through_cutter(unite(projected(frame, straight)), frame, y, config)};
  straight.insert(straight.end(), others.begin(), others.end());
  for (Solid& cutter : straight) cutter = overhanging(std::move(cutter), frame, y, config);
  return straight;
}

/// The uncut body of a wall as one solid.
Solid whole_body(const Wall& wall, const MeshConfig& config) {
  return wall.body ? *wall.body : std::get<Solid>(cut_in_elevation(wall, {}, config));
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
  for (const std::string& text : refusal.more) cut.warnings.push_back({wall.id, refusal.kind, text + "; cut in 3D"});
  cut.warnings.insert(cut.warnings.begin(), {wall.id, refusal.kind, refusal.text + "; cut in 3D"});
  if (refusal.kind.name() == "niche") return cut;
  for (const Opening& opening : openings)
    if (!goes_through(opening, wall))
      cut.warnings.push_back(
          {wall.id, "niche", "opening '" + opening.id + "' does not go through the wall; cut in 3D"});
  return cut;
}

}  // namespace plumbline::bim
