// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/shape.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bim/errors.h"
#include "bim/geometry/polygon_boolean.h"
#include "bim/mesh/boolean.h"
#include "bim/mesh/shells.h"
#include "bim/mesh/solid.h"
#include "bim/model/triangulate.h"

namespace plumbline::bim {
namespace {

using Ring = std::vector<Eigen::Vector3d>;

bool before(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

Eigen::Vector3d on_grid(const Eigen::Vector3d& p) {
  return p.unaryExpr([](double v) { return snap(v, solid_grid_m); });
}

/// The loop on the grid without repeated points, starting at its smallest vertex, so that its triangulation depends on
/// nothing but its shape.
Ring canonical_ring(const Facets& facets, const std::vector<int>& loop) {
  Ring ring;
  for (const int i : loop) {
    const Eigen::Vector3d p = on_grid(facets.points[static_cast<std::size_t>(i)]);
    if (ring.empty() || ring.back() != p) ring.push_back(p);
  }
  while (ring.size() > 1 && ring.back() == ring.front()) ring.pop_back();
  if (ring.size() >= 3) std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end(), before), ring.end());
  return ring;
}

/// Twice the vector area (Newell), m^2.
Eigen::Vector3d vector_area(const Ring& ring) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) sum += (ring[i] - ring[0]).cross(ring[i + 1] - ring[0]);
  return sum;
}

/// The ring seen along its normal, along the coordinate axis nearest to it; counter-clockwise.
Polygon2 flattened(const Ring& ring, const Eigen::Vector3d& normal) {
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  const Eigen::Index u = (axis + 1) % 3, v = (axis + 2) % 3;
  Polygon2 polygon;
  for (const Eigen::Vector3d& p : ring)
    polygon.emplace_back(normal[axis] > 0.0 ? Eigen::Vector2d(p[u], p[v]) : Eigen::Vector2d(p[v], p[u]));
  return polygon;
}

void add_triangle(Solid& solid, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const int first = static_cast<int>(solid.vertices.size());
  solid.vertices.insert(solid.vertices.end(), {a, b, c});
  solid.triangles.emplace_back(first, first + 1, first + 2);
}

void add_fan(Solid& solid, const Ring& ring) {
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) add_triangle(solid, ring[0], ring[i], ring[i + 1]);
}

bool is_convex(const Polygon2& polygon) {
  for (std::size_t i = 0, n = polygon.size(); i < n; ++i) {
    const Eigen::Vector2d e = polygon[(i + 1) % n] - polygon[i], f = polygon[(i + 2) % n] - polygon[(i + 1) % n];
    if (e.x() * f.y() - e.y() * f.x() <= 0.0) return false;
  }
  return true;
}

double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// True when corner i of what is left of a polygon can be cut off: it is convex, and no other corner but those at the
/// same places lies in its triangle.
bool is_ear(const Polygon2& flat, const std::vector<std::size_t>& left, std::size_t i) {
  const std::size_t n = left.size();
  const Eigen::Vector2d &a = flat[left[(i + n - 1) % n]], &b = flat[left[i]], &c = flat[left[(i + 1) % n]];
  if (turn(a, b, c) <= 0.0) return false;
  return std::none_of(left.begin(), left.end(), [&](std::size_t k) {
    const Eigen::Vector2d& p = flat[k];
    return p != a && p != b && p != c && turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
  });
}

/// Cuts off ears, always the first there is. Takes loops that run into their holes and back along one bridge, which
/// the converter makes of faces with holes. False when some loop has no ear.
bool add_ears(Solid& solid, const Ring& ring, const Polygon2& flat) {
  std::vector<std::size_t> left(ring.size());
  std::iota(left.begin(), left.end(), std::size_t{0});
  Solid ears;
  while (left.size() >= 3) {
    const std::size_t n = left.size();
    std::size_t i = 0;
    while (i < n && !is_ear(flat, left, i)) ++i;
    if (i == n) break;
    add_triangle(ears, ring[left[(i + n - 1) % n]], ring[left[i]], ring[left[(i + 1) % n]]);
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
  }
  // What is left of a valid loop is a line without area, traversed both ways.
  double rest = 0.0;
  for (std::size_t i = 1; i + 1 < left.size(); ++i) rest += turn(flat[left[0]], flat[left[i]], flat[left[i + 1]]);
  if (std::abs(rest) > solid_grid_m * solid_grid_m) return false;
  const int first = static_cast<int>(solid.vertices.size());
  solid.vertices.insert(solid.vertices.end(), ears.vertices.begin(), ears.vertices.end());
  for (const Eigen::Vector3i& t : ears.triangles) solid.triangles.push_back(t.array() + first);
  return true;
}

/// Faces with more corners than this are not cut into ears, which takes the square of their number.
constexpr std::size_t most_ears = 3000;

/// False where the face runs across itself, so that its triangles are a guess.
bool add_face(Solid& solid, const Ring& ring) {
  if (ring.size() < 3) return true;
  const Polygon2 flat = flattened(ring, vector_area(ring));
  if (ring.size() == 3 || is_convex(flat)) {
    add_fan(solid, ring);
    return true;
  }
  if (!is_simple(flat)) {
    if (ring.size() <= most_ears && add_ears(solid, ring, flat)) return true;
    add_fan(solid, ring);
    return false;
  }
  const FlatMesh mesh = triangulate({PolygonWithHoles2{flat, {}}});
  std::vector<std::size_t> corner(mesh.points.size());
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    corner[i] = static_cast<std::size_t>(std::find(flat.begin(), flat.end(), mesh.points[i]) - flat.begin());
  for (const FlatTriangle& t : mesh.triangles) {
    const auto p = [&](std::size_t k) { return ring[corner[static_cast<std::size_t>(t.points[k])]]; };
    add_triangle(solid, p(0), p(1), p(2));
  }
  return true;
}

}  // namespace

bool add_triangles(Facets& facets, const std::vector<std::vector<int>>& loops) {
  std::vector<Ring> rings;
  for (const std::vector<int>& loop : loops) {
    Ring& ring = rings.emplace_back();
    for (const int i : loop) ring.push_back(facets.points[static_cast<std::size_t>(i)]);
  }
  const Eigen::Vector3d normal = vector_area(rings.front());
  PolygonWithHoles2 face;
  Polygon2 points;
  std::vector<int> corners;
  for (std::size_t k = 0; k < rings.size(); ++k) {
    Polygon2 flat = flattened(rings[k], normal);
    if (!is_simple(flat)) return false;
    points.insert(points.end(), flat.begin(), flat.end());
    corners.insert(corners.end(), loops[k].begin(), loops[k].end());
    if ((signed_area(flat) > 0.0) != (k == 0)) std::reverse(flat.begin(), flat.end());
    (k == 0 ? face.outer : face.holes.emplace_back()) = std::move(flat);
  }
  FlatMesh mesh;
  try {
    mesh = triangulate({face});
  } catch (const InternalError&) {
    return false;
  }
  std::vector<int> corner(mesh.points.size());
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    const auto found = std::find(points.begin(), points.end(), mesh.points[i]);
    if (found == points.end()) return false;
    corner[i] = corners[static_cast<std::size_t>(found - points.begin())];
  }
  for (const FlatTriangle& t : mesh.triangles) {
    std::vector<int>& loop = facets.loops.emplace_back();
    for (const int i : t.points) loop.push_back(corner[static_cast<std::size_t>(i)]);
  }
  return true;
}

Facets transformed(const Eigen::Affine3d& X, Facets facets) {
  for (Eigen::Vector3d& p : facets.points) p = X * p;
  if (X.linear().determinant() < 0.0)
    for (std::vector<int>& loop : facets.loops) std::reverse(loop.begin(), loop.end());
  return facets;
}

Shape transformed(const Eigen::Affine3d& X, Shape shape) {
  shape.base = transformed(X, std::move(shape.base));
  for (Facets& facets : shape.minus) facets = transformed(X, std::move(facets));
  for (Facets& facets : shape.within) facets = transformed(X, std::move(facets));
  return shape;
}

Solid placed(const Eigen::Affine3d& X_WP, Solid solid) {
  for (Eigen::Vector3d& p : solid.vertices) p = X_WP * p;
  return canonical(solid, placed_grid_m);
}

Solid triangulated(const Facets& facets, int& crossed) {
  Solid solid;
  for (const std::vector<int>& loop : facets.loops) crossed += add_face(solid, canonical_ring(facets, loop)) ? 0 : 1;
  solid = without_slivers(welded(solid, solid_grid_m), solid_grid_m);
  // Reversed input: mirrored bodies and files whose shells point inwards, or some of whose faces do.
  return canonical(is_closed(solid) ? shells_turned_outward(solid) : turned_alike(solid), solid_grid_m);
}

Solid triangulated(const Facets& facets) {
  int crossed = 0;
  return triangulated(facets, crossed);
}

namespace {

Solid after(const Solid& body, const std::vector<BooleanStep>& steps, std::vector<std::string>& problems) {
  if (steps.empty()) return body;
  BooleanResult result = boolean_steps(body, steps, solid_grid_m);
  for (const std::size_t i : result.failed)
    problems.emplace_back(steps[i].operation == BooleanOperation::difference
                              ? "what should be cut off does not close, and stays"
                              : "what it should be cut down to does not close; the whole stays");
  if (result.closed) result.solid = without_slivers(std::move(result.solid), solid_grid_m);
  return canonical(result.solid, solid_grid_m);
}

}  // namespace

Solid without(Solid body, const std::vector<Solid>& cuts, std::vector<std::string>& problems) {
  std::vector<BooleanStep> steps;
  for (const Solid& cut : cuts) steps.push_back({BooleanOperation::difference, cut});
  return after(body, steps, problems);
}

Solid solid_of(const Shape& shape, std::vector<std::string>& problems, int& crossed) {
  std::vector<BooleanStep> steps;
  for (const Facets& facets : shape.within)
    steps.push_back({BooleanOperation::intersection, triangulated(facets, crossed)});
  for (const Facets& facets : shape.minus)
    steps.push_back({BooleanOperation::difference, triangulated(facets, crossed)});
  return after(triangulated(shape.base, crossed), steps, problems);
}

Solid solid_of(const Shape& shape, std::vector<std::string>& problems) {
  int crossed = 0;
  return solid_of(shape, problems, crossed);
}

Solid joined(const std::vector<Solid>& solids) {
  Solid all;
  for (const Solid& solid : solids) {
    const int first = static_cast<int>(all.vertices.size());
    all.vertices.insert(all.vertices.end(), solid.vertices.begin(), solid.vertices.end());
    for (const Eigen::Vector3i& t : solid.triangles) all.triangles.push_back(t.array() + first);
  }
  return all;
}

}  // namespace plumbline::bim
