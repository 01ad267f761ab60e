// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/write/write_shapes.h"

#include <cmath>

#include "bim/formats/ifc/step/step_string.h"
#include "bim/mesh/solid.h"

namespace plumbline::bim {

using step::none;
using step::ref;

namespace {

std::string coordinates(const Eigen::Vector3d& p) {
  return step::list({step_real(p.x()), step_real(p.y()), step_real(p.z())});
}

int add_faces(StepWriter& out, const Solid& solid) {
  std::vector<std::string> points, triangles;
  for (const Eigen::Vector3d& p : solid.vertices) points.push_back(coordinates(p));
  for (const Eigen::Vector3i& t : solid.triangles)
    triangles.push_back(step::list({step::integer(t[0] + 1), step::integer(t[1] + 1), step::integer(t[2] + 1)}));
  const int list = out.add("IFCCARTESIANPOINTLIST3D", {step::list(points)});
  return out.add("IFCTRIANGULATEDFACESET",
                 {ref(list), none, step::boolean(is_closed(solid)), step::list(triangles), none});
}

}  // namespace

ShapeWriter& ShapeWriter::body(const std::vector<Solid>& solids) {
  std::vector<int> items;
  for (const Solid& solid : solids)
    if (!solid.triangles.empty()) items.push_back(add_faces(document_.step(), solid));
  for (const int item : items) document_.assign_colour(item, colour_);
  if (!items.empty()) represent(document_.body_context(), "Body", "Tessellation", items);
  return *this;
}

ShapeWriter& ShapeWriter::body(const Prism& prism) {
  const double height = prism.z1_m - prism.z0_m;
  if (prism.outline.outer.empty() || !(height > 0.0)) return *this;
  StepWriter& out = document_.step();
  std::vector<std::string> profile{".AREA.", none, ref(polyline(prism.outline.outer, true))};
  std::vector<int> holes;
  for (const Polygon2& hole : prism.outline.holes) holes.push_back(polyline(hole, true));
  if (!holes.empty()) profile.push_back(step::refs(holes));
  const int area = out.add(holes.empty() ? "IFCARBITRARYCLOSEDPROFILEDEF" : "IFCARBITRARYPROFILEDEFWITHVOIDS", profile);
  const int corner = out.add("IFCCARTESIANPOINT", {coordinates({0.0, 0.0, prism.z0_m})});
  const int axes = out.add("IFCAXIS2PLACEMENT3D", {ref(corner), none, none});
  const Eigen::Vector3d direction(prism.lean.x(), prism.lean.y(), 1.0);
  const int up = out.add("IFCDIRECTION", {coordinates(direction)});
  const int solid =
      out.add("IFCEXTRUDEDAREASOLID", {ref(area), ref(axes), ref(up), step_real(height * direction.norm())});
  document_.assign_colour(solid, colour_);
  represent(document_.body_context(), "Body", "SweptSolid", {solid});
  return *this;
}

ShapeWriter& ShapeWriter::axis(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  represent(document_.axis_context(), "Axis", "Curve2D", {polyline({a, b}, false)});
  return *this;
}

ShapeWriter& ShapeWriter::footprint(const PolygonWithHoles2& outline) {
  if (outline.outer.empty()) return *this;
  std::vector<int> rings{polyline(outline.outer, true)};
  for (const Polygon2& hole : outline.holes) rings.push_back(polyline(hole, true));
  represent(document_.footprint_context(), "FootPrint", "Curve2D", rings);
  return *this;
}

int ShapeWriter::finish() {
  if (representations_.empty()) return 0;
  return document_.step().add("IFCPRODUCTDEFINITIONSHAPE", {none, none, step::refs(representations_)});
}

int ShapeWriter::polyline(const Polygon2& points, bool closed) {
  std::vector<int> numbers;
  for (const Eigen::Vector2d& p : points)
    numbers.push_back(document_.step().add("IFCCARTESIANPOINT", {step::list({step_real(p.x()), step_real(p.y())})}));
  if (closed) numbers.push_back(numbers.front());
  return document_.step().add("IFCPOLYLINE", {step::refs(numbers)});
}

void ShapeWriter::represent(int context, const char* name, const char* type, const std::vector<int>& items) {
  representations_.push_back(document_.step().add(
      "IFCSHAPEREPRESENTATION", {ref(context), step_string(name), step_string(type), step::refs(items)}));
}

}  // namespace plumbline::bim
