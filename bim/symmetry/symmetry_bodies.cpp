// SPDX-License-Identifier: Apache-2.0
#include "bim/symmetry/symmetry_bodies.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "bim/config/tree.h"
#include "bim/mesh/solid.h"
#include "bim/model/materials.h"
#include "bim/model/triangulate.h"
#include "bim/model/walked_floors.h"
#include "bim/model/wall_face.h"

namespace plumbline::bim {

namespace {

struct Span {
  double low = 0.0, high = 0.0;
};

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

bool before(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
}

/// Convex hull, counter-clockwise.
Polygon2 hull(Polygon2 points) {
  std::sort(points.begin(), points.end(), before);
  Polygon2 ring;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t base = ring.size();
    for (const Eigen::Vector2d& p : points) {
      while (ring.size() >= base + 2 && cross(ring.back() - ring[ring.size() - 2], p - ring.back()) <= 0.0)
        ring.pop_back();
      ring.push_back(p);
    }
    if (!ring.empty()) ring.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return ring;
}

Polygon2 seen_from_above(const Solid& solid, const Eigen::Vector3i& t, bool flip) {
  Polygon2 polygon;
  for (const int corner : t) polygon.push_back(solid.vertices[static_cast<std::size_t>(corner)].head<2>());
  if (flip) std::reverse(polygon.begin(), polygon.end());
  return polygon;
}

double upward(const Solid& solid, const Eigen::Vector3i& t) {
  const auto at = [&](int i) -> const Eigen::Vector3d& { return solid.vertices[static_cast<std::size_t>(t[i])]; };
  const Eigen::Vector3d normal = (at(1) - at(0)).cross(at(2) - at(0));
  const double length = normal.norm();
  return length > 0.0 ? normal.z() / length : 0.0;
}

/// Floor to ceiling of most of the storey's rooms, by area: what stands above hanging ceilings is out of sight.
double clear_height(const Building& building, int storey) {
  std::vector<std::pair<double, double>> heights;
  double total = 0.0;
  for (const Room& room : building.rooms) {
    if (room.storey != storey) continue;
    heights.emplace_back(room.z1_m - building.storeys[static_cast<std::size_t>(storey)].elevation_m, room.area_m2());
    total += heights.back().second;
  }
  std::sort(heights.begin(), heights.end());
  double below = 0.0;
  for (const auto& [height, area] : heights) {
    below += area;
    if (2.0 * below >= total && height > 0.0) return height;
  }
  return building.storeys[static_cast<std::size_t>(storey)].height_m;
}

/// Furniture of a model moves and is modelled at will; clutter of a plan is there on purpose.
bool is_loose(const Obstacle& obstacle) {
  return obstacle.kind == "furniture" || obstacle.kind == "covering" || obstacle.kind == "proxy";
}

/// Collects the bodies of one storey.
class Collector {
 public:
  Collector(const Building& building, int storey, const SymmetryBodiesConfig& config)
      : building_(building),
        config_(config),
        floor_z_(building.storeys[static_cast<std::size_t>(storey)].elevation_m),
        height_m_(clear_height(building, storey)) {
    bodies_.storey = storey;
  }

  SymmetryBodies collect() {
    std::vector<std::vector<const Opening*>> openings(building_.walls.size());
    for (const Opening& opening : building_.openings)
      if (opening.wall >= 0) openings[static_cast<std::size_t>(opening.wall)].push_back(&opening);
    for (std::size_t i = 0; i < building_.walls.size(); ++i) add_wall(building_.walls[i], openings[i]);
    add_raised_floors();
    for (const Column& column : building_.columns) add_column(column);
    for (const Stair& stair : building_.stairs) {
      bodies_.elements.push_back(stair.id);
      for (const Solid& body : stair.bodies) add_solid(body);
    }
    for (const Obstacle& obstacle : building_.obstacles) {
      bodies_.elements.push_back(obstacle.id);
      const bool hidden = !obstacle.planned || is_loose(obstacle) || is_see_through(building_, obstacle.material);
      if (!hidden) add_solid(obstacle.body);
    }
    leave_out_what_is_around();
    return std::move(bodies_);
  }

 private:
  /// Adds to the element named last, cut to the storey.
  void add(const Polygon2& outline, double z0, double z1) {
    const double low = std::max(0.0, z0 - floor_z_), high = std::min(height_m_, z1 - floor_z_);
    if (high - low <= config_.height_min_m || outline.size() < 3 || signed_area(outline) <= config_.area_min_m2) return;
    bodies_.prisms.push_back({outline, low, high, static_cast<int>(bodies_.elements.size()) - 1});
  }

  /// A storey whose halves lie at different heights is not alike, whatever its walls.
  void add_raised_floors() {
    const WalkedFloors floors = walked_floors(building_, bodies_.storey);
    for (const RaisedFloor& floor : floors.raised) {
      if (!floor.is_level()) continue;
      bodies_.elements.push_back("floor at " + format_number(std::round(floor.z_m * 1e2) / 1e2) + " m");
      const FlatMesh flat = triangulate({floor.polygon});
      std::vector<Polygon2> triangles;
      for (const FlatTriangle& t : flat.triangles) {
        Polygon2& corners = triangles.emplace_back();
        for (const int corner : t.points) corners.push_back(flat.points[static_cast<std::size_t>(corner)]);
      }
      for (const Polygon2& part : convex_parts(std::move(triangles)))
        add(part, floor_z_, floor_z_ + floor.z_m - floors.ground_m);
    }
  }

  void add_wall(const Wall& wall, const std::vector<const Opening*>& openings) {
    bodies_.elements.push_back(wall.id);
    if (is_see_through(building_, wall.material)) return;
    const std::vector<Span> cuts = spans_along(wall, openings);
    const Eigen::Vector2d e = wall.direction();
    for (const Polygon2& outline : outlines_of(wall)) {
      for (const Span& s : cuts) {
        const Polygon2 piece = clipped(clipped(outline, e, e.dot(wall.a) + s.high), -e, -(e.dot(wall.a) + s.low));
        if (piece.size() < 3) continue;
        for (const Span& z : spans_up(wall, openings, 0.5 * (s.low + s.high))) add(piece, z.low, z.high);
      }
    }
  }

  /// Seen from above: the rectangle of reference line and thickness; of a body from a model its underside, which
  /// has mitres and edited ends.
  [[nodiscard]] std::vector<Polygon2> outlines_of(const Wall& wall) const {
    constexpr double complete = 0.5;
    std::vector<Polygon2> outlines;
    double area = 0.0;
    if (wall.body) {
      for (const Eigen::Vector3i& t : wall.body->triangles) {
        if (upward(*wall.body, t) > -config_.flat) continue;
        outlines.push_back(seen_from_above(*wall.body, t, true));
        area += signed_area(outlines.back());
      }
    }
    const Polygon2 rectangle = footprint(wall);
    if (area < complete * signed_area(rectangle)) return {rectangle};
    return convex_parts(std::move(outlines));
  }

  /// The wall's length, divided where an opening begins or ends.
  [[nodiscard]] static std::vector<Span> spans_along(const Wall& wall, const std::vector<const Opening*>& openings) {
    constexpr double beyond_m = 1e6;
    std::vector<double> cuts = {-beyond_m, wall.length() + beyond_m};
    for (const Opening* opening : openings) {
      cuts.push_back(opening->s_m - 0.5 * opening->width_m);
      cuts.push_back(opening->s_m + 0.5 * opening->width_m);
    }
    std::sort(cuts.begin(), cuts.end());
    std::vector<Span> spans;
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i)
      if (cuts[i + 1] > cuts[i]) spans.push_back({cuts[i], cuts[i + 1]});
    return spans;
  }

  /// What is left of the wall's height at s.
  [[nodiscard]] static std::vector<Span> spans_up(const Wall& wall, const std::vector<const Opening*>& openings,
                                                  double s) {
    std::vector<Span> spans = {{wall.z0_m, wall.z1_m}};
    for (const Opening* opening : openings) {
      if (std::abs(s - opening->s_m) >= 0.5 * opening->width_m) continue;
      std::vector<Span> left;
      for (const Span& span : spans) {
        const Span under{span.low, std::min(span.high, opening->z0_m)},
            over{std::max(span.low, opening->z1_m), span.high};
        if (under.high > under.low) left.push_back(under);
        if (over.high > over.low) left.push_back(over);
      }
      spans = std::move(left);
    }
    return spans;
  }

  void add_column(const Column& column) {
    bodies_.elements.push_back(column.id);
    if (is_see_through(building_, column.material)) return;
    if (column.body)
      add_solid(*column.body);
    else
      add(hull(column.footprint), column.z0_m, column.z1_m);
  }

  void add_solid(const Solid& solid) {
    if (solid.vertices.empty()) return;
    double bottom = solid.vertices.front().z(), top = bottom;
    for (const Eigen::Vector3d& p : solid.vertices) {
      bottom = std::min(bottom, p.z());
      top = std::max(top, p.z());
    }
    std::vector<BodyPrism> tops;
    double filled = 0.0;
    for (const Eigen::Vector3i& t : solid.triangles) {
      if (upward(solid, t) <= config_.flat) continue;
      double low = top, high = bottom;
      for (const int corner : t) {
        low = std::min(low, solid.vertices[static_cast<std::size_t>(corner)].z());
        high = std::max(high, solid.vertices[static_cast<std::size_t>(corner)].z());
      }
      tops.push_back({seen_from_above(solid, t, false), bottom, high, -1});
      filled += signed_area(tops.back().outline) * (0.5 * (low + high) - bottom);
    }
    const bool heights = is_closed(solid) && filled <= config_.filled * volume(solid);
    if (heights && static_cast<int>(tops.size()) <= config_.triangles_max) {
      for (const BodyPrism& prism : tops) add(prism.outline, prism.z0, prism.z1);
      return;
    }
    Polygon2 points;
    for (const Eigen::Vector3d& p : solid.vertices) points.emplace_back(p.head<2>());
    const Polygon2 outline = hull(std::move(points));
    const double inside = is_closed(solid) ? volume(solid) : 0.0;
    if (inside < config_.hollow * signed_area(outline) * (top - bottom)) hollow_.insert(bodies_.elements.size() - 1);
    add(outline, bottom, top);
  }

  /// A hollow body around most of its storey.
  void leave_out_what_is_around() {
    Polygon2 points;
    for (const BodyPrism& prism : bodies_.prisms)
      points.insert(points.end(), prism.outline.begin(), prism.outline.end());
    const double most_m2 = config_.around * std::abs(signed_area(hull(std::move(points))));
    std::erase_if(bodies_.prisms, [&](const BodyPrism& prism) {
      const auto element = static_cast<std::size_t>(prism.element);
      if (!hollow_.contains(element) || signed_area(prism.outline) < most_m2) return false;
      bodies_.left_out.push_back(bodies_.elements[element]);
      return true;
    });
  }

  const Building& building_;
  const SymmetryBodiesConfig& config_;
  double floor_z_ = 0.0, height_m_ = 0.0;
  SymmetryBodies bodies_;
  std::set<std::size_t> hollow_;  ///< into its elements
};

}  // namespace

SymmetryBodies symmetry_bodies(const Building& building, int storey, const SymmetryBodiesConfig& config) {
  return Collector(building, storey, config).collect();
}

}  // namespace plumbline::bim
