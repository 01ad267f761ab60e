// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "bim/errors.h"
#include "bim/geometry/polygon_boolean.h"
#include "bim/mesh/solid.h"
#include "bim/mesh/straight_opening.h"
#include "bim/mesh/wall_cut.h"
#include "bim/model/extrude.h"
#include "bim/model/wall_frame.h"

namespace plumbline::bim {

namespace {

/// The wall's outline in (x, z) with its ends stretched to the longer face, and how to place it on the two faces.
struct Elevation {
  Region2 region;
  Interval y;       ///< the two faces
  Interval x;       ///< the stretched ends
  Interval x_low;   ///< the ends on the face at y.low
  Interval x_high;  ///< the ends on the face at y.high
};

Refusal not_prismatic(std::string text) { return {"not_prismatic", std::move(text)}; }

Polygon2 rectangle(double x0, double x1, double z0, double z1) { return {{x0, z0}, {x1, z0}, {x1, z1}, {x0, z1}}; }

bool near(double a, double b, double tolerance) { return std::abs(a - b) <= tolerance; }

Elevation plain_elevation(const Wall& wall) {
  const Polygon2 outline = rectangle(0.0, wall.length(), wall.z0_m, wall.z1_m);
  const Interval ends{0.0, wall.length()};
  return {unite(std::vector<Polygon2>{outline}), {wall.offset_m, wall.offset_m + wall.thickness_m}, ends, ends, ends};
}

/// Outline of the body's triangles that lie on the face at y.
Region2 face_outline(const WallFrame& frame, const Solid& body, double y, double tolerance) {
  const auto on_face = [&](int i) {
    return near(frame.to_wall(body.vertices[static_cast<std::size_t>(i)]).y(), y, tolerance);
  };
  Solid face{body.vertices, {}};
  for (const Eigen::Vector3i& t : body.triangles)
    if (on_face(t[0]) && on_face(t[1]) && on_face(t[2])) face.triangles.push_back(t);
  return unite(projected(frame, {face}));
}

Interval x_extent(const Polygon2& outline) {
  Interval x;
  for (const Eigen::Vector2d& p : outline) x.add(p.x());
  return x;
}

/// The face's outline with the vertices at its ends moved to the stretched ends.
PolygonWithHoles2 stretched(PolygonWithHoles2 face, const Interval& from, const Interval& to, double tolerance) {
  for (Eigen::Vector2d& p : face.outer) {
    if (near(p.x(), from.low, tolerance))
      p.x() = to.low;
    else if (near(p.x(), from.high, tolerance))
      p.x() = to.high;
  }
  return face;
}

Region2 region_of(const PolygonWithHoles2& face) {
  return subtract(unite(std::vector<Polygon2>{face.outer}), face.holes);
}

double perimeter(const Polygon2& ring) {
  double sum = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) sum += (ring[(i + 1) % ring.size()] - ring[i]).norm();
  return sum;
}

/// Elevation of a body, or why it has none.
std::variant<Elevation, Refusal> body_elevation(const WallFrame& frame, const Solid& body, const MeshConfig& config) {
  const Interval y = extent_across(frame, {body});
  for (const Eigen::Vector3d& p : frame.to_wall(body.vertices))
    if (!near(p.y(), y.low, config.face_m) && !near(p.y(), y.high, config.face_m))
      return not_prismatic("a vertex lies between the two faces");
  if (y.high - y.low <= 2.0 * config.face_m) return not_prismatic("the body has no thickness");

  const Region2 low = face_outline(frame, body, y.low, config.face_m);
  const Region2 high = face_outline(frame, body, y.high, config.face_m);
  if (low.size() != 1 || high.size() != 1) return not_prismatic("a face is not in one piece");

  const Interval x_low = x_extent(low[0].outer), x_high = x_extent(high[0].outer);
  const Interval x{std::min(x_low.low, x_high.low), std::max(x_low.high, x_high.high)};
  const PolygonWithHoles2 low_face = stretched(low[0], x_low, x, config.face_m);
  const PolygonWithHoles2 high_face = stretched(high[0], x_high, x, config.face_m);
  if (!is_simple(low_face.outer) || !is_simple(high_face.outer)) return not_prismatic("an end folds over the face");

  const Region2 region = region_of(low_face), other = region_of(high_face);
  const double difference = area(region) + area(other) - 2.0 * area(intersect(region, other));
  if (difference > config.face_m * perimeter(low_face.outer)) return not_prismatic("the two faces differ");
  return Elevation{region, y, x, x_low, x_high};
}

/// Adds the silhouette of an opening, or says why it has none.
std::optional<Refusal> add_silhouette(const WallFrame& frame, const Opening& opening, const Interval& y,
                                      const MeshConfig& config, std::vector<Polygon2>& silhouettes) {
  const std::vector<Solid> solids = solids_of(opening);
  if (solids.empty()) {
    const double half = 0.5 * opening.width_m;
    silhouettes.push_back(rectangle(opening.s_m - half, opening.s_m + half, opening.z0_m, opening.z1_m));
    return std::nullopt;
  }
  const Interval depth = extent_across(frame, solids);
  if (depth.low >= y.high || depth.high <= y.low) return std::nullopt;  // beside the wall
  const std::vector<Polygon2> flat = projected(frame, solids);
  silhouettes.insert(silhouettes.end(), flat.begin(), flat.end());
  if (depth.low > y.low + config.depth_m || depth.high < y.high - config.depth_m)
    return Refusal{"niche", "opening '" + opening.id + "' does not go through the wall"};
  if (!goes_straight_through(solids, frame, y, config))
    return not_prismatic("opening '" + opening.id + "' does not go straight through the wall");
  return std::nullopt;
}

/// Pushes what ends at an end of the wall past it, since the film left between the two would collapse with the end; and
/// what ends where a mitre begins away from it, since the wall would touch itself along that line.
void clear_of_ends(std::vector<Polygon2>& silhouettes, const Elevation& e, double tolerance) {
  const double low = std::max(e.x_low.low, e.x_high.low), high = std::min(e.x_low.high, e.x_high.high);
  for (Polygon2& silhouette : silhouettes) {
    for (Eigen::Vector2d& p : silhouette) {
      if (near(p.x(), e.x.low, tolerance))
        p.x() = e.x.low - tolerance;
      else if (near(p.x(), e.x.high, tolerance))
        p.x() = e.x.high + tolerance;
      else if (near(p.x(), low, tolerance))
        p.x() = low + tolerance;
      else if (near(p.x(), high, tolerance))
        p.x() = high - tolerance;
    }
  }
}

/// In a mitred end only the end itself may have vertices: anything between would fold when the end is slanted.
bool bends_in_a_mitre(const Elevation& e, double tolerance) {
  const double clear_low = std::max(e.x_low.low, e.x_high.low), clear_high = std::min(e.x_low.high, e.x_high.high);
  const auto bends = [&](const Eigen::Vector2d& p) {
    const bool at_end = near(p.x(), e.x.low, tolerance) || near(p.x(), e.x.high, tolerance);
    return !at_end && (p.x() < clear_low || p.x() > clear_high);
  };
  return std::any_of(e.region.begin(), e.region.end(), [&](const PolygonWithHoles2& piece) {
    return std::any_of(piece.outer.begin(), piece.outer.end(), bends) ||
           std::any_of(piece.holes.begin(), piece.holes.end(),
                       [&](const Polygon2& hole) { return std::any_of(hole.begin(), hole.end(), bends); });
  });
}

Placement on_face(const WallFrame& frame, const Elevation& e, double y, const Interval& ends, double tolerance) {
  return [&frame, stretched_ends = e.x, y, ends, tolerance](const Eigen::Vector2d& p) {
    double x = p.x();
    if (near(x, stretched_ends.low, tolerance))
      x = ends.low;
    else if (near(x, stretched_ends.high, tolerance))
      x = ends.high;
    return frame.to_world({x, y, p.y()});
  };
}

}  // namespace

std::variant<Solid, Refusal> cut_in_elevation(const Wall& wall, const std::vector<Opening>& openings,
                                              const MeshConfig& config) {
  const WallFrame frame(wall);
  std::variant<Elevation, Refusal> outline =
      wall.body ? body_elevation(frame, *wall.body, config) : plain_elevation(wall);
  if (std::holds_alternative<Refusal>(outline)) return std::get<Refusal>(outline);
  Elevation elevation = std::get<Elevation>(std::move(outline));

  std::vector<Polygon2> silhouettes;
  std::optional<Refusal> refused;
  for (const Opening& opening : openings) {
    const auto refusal = add_silhouette(frame, opening, elevation.y, config, silhouettes);
    if (refusal && refused && refusal->kind.name() == refused->kind.name())
      refused->more.push_back(refusal->text);
    else if (refusal && !refused)
      refused = refusal;
  }
  if (refused) return *refused;
  clear_of_ends(silhouettes, elevation, config.face_m);
  try {
    elevation.region = subtract(elevation.region, silhouettes);
    if (bends_in_a_mitre(elevation, config.face_m)) return not_prismatic("an opening reaches into a slanted end");

    // Along the wall, then up, is counter-clockwise seen from the right of the wall: the face at y.low is the high cap.
    return extrude_between(elevation.region,
                           on_face(frame, elevation, elevation.y.high, elevation.x_high, config.face_m),
                           on_face(frame, elevation, elevation.y.low, elevation.x_low, config.face_m));
  } catch (const InternalError&) {  // one wall must not end the whole file
    return not_prismatic("the outlines of its openings cross");
  }
}

}  // namespace plumbline::bim
