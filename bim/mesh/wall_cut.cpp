// SPDX-License-Identifier: Apache-2.0
#include "bim/mesh/wall_cut.h"

#include <algorithm>
#include <utility>

#include "bim/geometry/polygon_boolean.h"
#include "bim/mesh/corefine.h"
#include "bim/mesh/solid.h"
#include "bim/mesh/sweep.h"
#include "bim/mesh/wall_frame.h"

namespace plumbline::bim {

namespace {

struct Across {
  double low = 0.0, high = 0.0;
};

/// Extent of the wall across its reference line.
Across thickness_of(const Wall& wall, const WallFrame& frame) {
  if (!wall.body || wall.body->vertices.empty()) return {wall.offset_m, wall.offset_m + wall.thickness_m};
  const auto points = frame.to_wall(wall.body->vertices);
  const auto [low, high] = std::minmax_element(
      points.begin(), points.end(), [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a.y() < b.y(); });
  return {low->y(), high->y()};
}

/// Box through the whole wall.
Solid rectangle_cutter(const Opening& opening, const WallFrame& frame, const Across& y, const MeshConfig& config) {
  const double x0 = opening.s_m - 0.5 * opening.width_m, x1 = opening.s_m + 0.5 * opening.width_m;
  const Polygon2 outline = {{x0, y.low - config.margin_m},
                            {x1, y.low - config.margin_m},
                            {x1, y.high + config.margin_m},
                            {x0, y.high + config.margin_m}};
  Solid box = extrude(unite(std::vector<Polygon2>{outline}), opening.z0_m, opening.z1_m);
  for (Eigen::Vector3d& p : box.vertices) p = frame.to_world(p);
  return box;
}

/// Pushes what ends at a face of the wall out of it: rounding would otherwise leave a film across the opening.
Solid overhanging(Solid cutter, const WallFrame& frame, const Across& y, const MeshConfig& config) {
  for (Eigen::Vector3d& p_W : cutter.vertices) {
    Eigen::Vector3d p = frame.to_wall(p_W);
    if (p.y() <= y.low + config.depth_m) p.y() = std::min(p.y(), y.low - config.margin_m);
    if (p.y() >= y.high - config.depth_m) p.y() = std::max(p.y(), y.high + config.margin_m);
    p_W = frame.to_world(p);
  }
  return cutter;
}

std::vector<Solid> cutters_of(const Opening& opening, const WallFrame& frame, const Across& y,
                              const MeshConfig& config) {
  std::vector<Solid> cutters = solids_of(opening);
  if (cutters.empty()) return {rectangle_cutter(opening, frame, y, config)};
  for (Solid& cutter : cutters) cutter = overhanging(std::move(cutter), frame, y, config);
  return cutters;
}

/// The uncut body of a wall as one solid.
Solid whole_body(const Wall& wall, const MeshConfig& config) {
  if (wall.body) return *wall.body;
  Wall plain = wall;
  return std::get<Solid>(cut_in_elevation(plain, {}, config));
}

CutWall cut_in_space(const Wall& wall, const std::vector<Opening>& openings, const MeshConfig& config) {
  const WallFrame frame(wall);
  const Across y = thickness_of(wall, frame);
  CutWall cut;
  const Solid whole = whole_body(wall, config);
  std::optional<Solid> body = repaired(whole);
  cut.closed = body.has_value();
  if (!body) {
    cut.warnings.push_back({wall.id, "not_closed", "the body's surface does not close; openings are not cut"});
    cut.solid = canonical(welded(whole, config.weld_m), config.grid_m);
    return cut;
  }
  for (const Opening& opening : openings) {
    for (const Solid& part : cutters_of(opening, frame, y, config)) {
      const std::optional<Solid> cutter = repaired(part);
      std::optional<Solid> rest = cutter ? difference(*body, *cutter) : std::nullopt;
      if (rest)
        body = std::move(rest);
      else
        cut.warnings.push_back({wall.id, "not_cut", "opening '" + opening.id + "' could not be cut out"});
    }
  }
  cut.solid = canonical(*body, config.grid_m);
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
