// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bim/geometry/polygon.h"

namespace plumbline::bim {

/// Writes an IFC4 file entity by entity, in metres. Every function returns what it wrote as "#number".
class Sketch {
 public:
  std::string schema = "IFC4";

  Sketch() {
    up_ = add("IFCDIRECTION((0.,0.,1.))");
    origin_ = frame(0, 0, 0);
    const std::string unit = add("IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.)");
    const std::string units = add("IFCUNITASSIGNMENT((" + unit + "))");
    context_ = add("IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,1.E-5," + origin_ + ",$)");
    project = rooted("IFCPROJECT", "'sketch',$,$,$,$,(" + context_ + ")," + units);
    place_ = add("IFCLOCALPLACEMENT($," + origin_ + ")");
    building = rooted("IFCBUILDING", "'b',$,$," + place_ + ",$,$,.ELEMENT.,$,$,$");
    rooted("IFCRELAGGREGATES", "$,$," + project + ",(" + building + ")");
  }

  std::string add(const std::string& entity) {
    lines_.push_back(entity);
    return "#" + std::to_string(lines_.size());
  }
  /// The 22 characters of the id count up.
  std::string rooted(const std::string& type, const std::string& rest) {
    std::string id = std::to_string(++ids_);
    id.insert(0, 22 - id.size(), '0');
    return add(type + "('" + id + "',$," + rest + ")");
  }

  static std::string n(double v) { return std::to_string(v); }
  std::string point(double x, double y) { return add("IFCCARTESIANPOINT((" + n(x) + "," + n(y) + "))"); }
  std::string point(double x, double y, double z) {
    return add("IFCCARTESIANPOINT((" + n(x) + "," + n(y) + "," + n(z) + "))");
  }
  std::string frame(double x, double y, double z) { return add("IFCAXIS2PLACEMENT3D(" + point(x, y, z) + ",$,$)"); }
  /// With its z and x axes, such as "0.,0.,1.".
  std::string frame(double x, double y, double z, const std::string& axis, const std::string& reference) {
    return add("IFCAXIS2PLACEMENT3D(" + point(x, y, z) + "," + add("IFCDIRECTION((" + axis + "))") + "," +
               add("IFCDIRECTION((" + reference + "))") + ")");
  }
  std::string polyline(const Polygon2& outline) {
    std::string points;
    for (std::size_t i = 0; i <= outline.size(); ++i) {
      const Eigen::Vector2d& p = outline[i % outline.size()];
      points += (i > 0 ? "," : "") + point(p.x(), p.y());
    }
    return add("IFCPOLYLINE((" + points + "))");
  }
  std::string extruded(const std::string& profile, double z0, double z1) {
    return add("IFCEXTRUDEDAREASOLID(" + profile + "," + frame(0, 0, z0) + "," + up_ + "," + n(z1 - z0) + ")");
  }
  std::string prism(const Polygon2& outline, double z0, double z1) {
    return extruded(add("IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$," + polyline(outline) + ")"), z0, z1);
  }
  std::string box(double x0, double y0, double z0, double x1, double y1, double z1) {
    return prism({{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, z0, z1);
  }
  std::string difference(const std::string& a, const std::string& b) {
    return add("IFCBOOLEANCLIPPINGRESULT(.DIFFERENCE.," + a + "," + b + ")");
  }
  /// What lies on the side of a plane that its normal points to is taken away.
  std::string half_space(const std::string& plane_frame, bool agreement = false) {
    return add("IFCHALFSPACESOLID(" + add("IFCPLANE(" + plane_frame + ")") + (agreement ? ",.T.)" : ",.F.)"));
  }
  std::string half_space(const std::string& plane_frame, const Polygon2& outline, const std::string& boundary_frame,
                         bool agreement = false) {
    return add("IFCPOLYGONALBOUNDEDHALFSPACE(" + add("IFCPLANE(" + plane_frame + ")") +
               (agreement ? ",.T.," : ",.F.,") + boundary_frame + "," + polyline(outline) + ")");
  }
  /// Triangles, which need not close.
  std::string shell(const std::vector<std::vector<Eigen::Vector3d>>& loops) {
    std::string faces;
    for (const auto& loop : loops) {
      std::string points;
      for (const Eigen::Vector3d& p : loop) points += (points.empty() ? "" : ",") + point(p.x(), p.y(), p.z());
      const std::string bound = add("IFCFACEOUTERBOUND(" + add("IFCPOLYLOOP((" + points + "))") + ",.T.)");
      faces += (faces.empty() ? "" : ",") + add("IFCFACE((" + bound + "))");
    }
    return add("IFCFACETEDBREP(" + add("IFCCLOSEDSHELL((" + faces + "))") + ")");
  }

  std::string shape(const std::string& items, const std::string& type = "SolidModel") {
    return add("IFCPRODUCTDEFINITIONSHAPE($,$,(" +
               add("IFCSHAPEREPRESENTATION(" + context_ + ",'Body','" + type + "',(" + items + "))") + "))");
  }
  /// Shape with an Axis along x from 0 to `length`.
  std::string wall_shape(const std::string& items, double length) {
    const std::string axis = add("IFCPOLYLINE((" + point(0, 0) + "," + point(length, 0) + "))");
    return add("IFCPRODUCTDEFINITIONSHAPE($,$,(" +
               add("IFCSHAPEREPRESENTATION(" + context_ + ",'Axis','Curve2D',(" + axis + "))") + "," +
               add("IFCSHAPEREPRESENTATION(" + context_ + ",'Body','SolidModel',(" + items + "))") + "))");
  }
  std::string storey(double z) {
    const std::string at = add("IFCLOCALPLACEMENT(" + place_ + "," + frame(0, 0, z) + ")");
    return storey(at, n(z));
  }
  /// With its placement and elevation, either of which may be "$".
  std::string storey(const std::string& at, const std::string& elevation) {
    const std::string id = rooted("IFCBUILDINGSTOREY", "'s',$,$," + at + ",$,$,.ELEMENT.," + elevation);
    rooted("IFCRELAGGREGATES", "$,$," + building + ",(" + id + ")");
    storey_ = id;
    return id;
  }
  /// An element of the storey begun last, if any; `rest` comes behind its shape.
  std::string element(const std::string& type, const std::string& items_shape, const std::string& rest,
                      const std::string& at_frame = {}) {
    const std::string at = add("IFCLOCALPLACEMENT(" + place_ + "," + (at_frame.empty() ? origin_ : at_frame) + ")");
    const std::string id = rooted(type, "'" + type + "',$,$," + at + "," + items_shape + "," + rest);
    if (!storey_.empty()) rooted("IFCRELCONTAINEDINSPATIALSTRUCTURE", "$,$,(" + id + ")," + storey_);
    return id;
  }
  /// A box from a along x or y; its reference line runs in the middle.
  std::string wall(double x, double y, double length, double thickness, double height, bool along_y = false) {
    const std::string at = along_y ? frame(x, y, 0, "0.,0.,1.", "0.,1.,0.") : frame(x, y, 0);
    return element("IFCWALL", wall_shape(box(0, -thickness / 2, 0, length, thickness / 2, height), length), "$,$", at);
  }
  std::string slab(const Polygon2& outline, double z0, double z1) {
    return element("IFCSLAB", shape(prism(outline, z0, z1)), "$,.FLOOR.");
  }
  /// Without a body: `items` are of its FootPrint or Box.
  std::string bare_space(const std::string& name, const std::string& identifier, const std::string& items) {
    const std::string at = add("IFCLOCALPLACEMENT(" + place_ + "," + origin_ + ")");
    const std::string shape =
        add("IFCPRODUCTDEFINITIONSHAPE($,$,(" +
            add("IFCSHAPEREPRESENTATION(" + context_ + ",'" + identifier + "','" + identifier + "',(" + items + "))") +
            "))");
    const std::string id = rooted("IFCSPACE", "'" + name + "',$,$," + at + "," + shape + ",$,.ELEMENT.,.INTERNAL.,$");
    rooted("IFCRELAGGREGATES", "$,$," + storey_ + ",(" + id + ")");
    return id;
  }
  std::string opening(const std::string& host, const std::string& items) {
    const std::string at = add("IFCLOCALPLACEMENT(" + place_ + "," + origin_ + ")");
    const std::string id = rooted("IFCOPENINGELEMENT", "'o',$,$," + at + "," + shape(items) + ",$,$");
    rooted("IFCRELVOIDSELEMENT", "$,$," + host + "," + id);
    return id;
  }
  std::string door(const std::string& in_opening) {
    const std::string at = add("IFCLOCALPLACEMENT(" + place_ + "," + origin_ + ")");
    const std::string id = rooted("IFCDOOR", "'d',$,$," + at + ",$,$,$,$,$,$,$");
    rooted("IFCRELFILLSELEMENT", "$,$," + in_opening + "," + id);
    return id;
  }

  [[nodiscard]] std::string text() const {
    std::string result =
        "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\nFILE_SCHEMA(('" +
        schema + "'));\nENDSEC;\nDATA;\n";
    for (std::size_t i = 0; i < lines_.size(); ++i) result += "#" + std::to_string(i + 1) + "=" + lines_[i] + ";\n";
    return result + "ENDSEC;\nEND-ISO-10303-21;\n";
  }

  std::string project, building;

 private:
  std::vector<std::string> lines_;
  int ids_ = 0;
  std::string up_, origin_, context_, place_, storey_;
};

}  // namespace plumbline::bim
