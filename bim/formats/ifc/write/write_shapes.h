// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "bim/formats/ifc/write/write_document.h"
#include "bim/model/building.h"

namespace plumbline::bim {

/// An upright or leaning prism: the plan outline at z0, which moves by `lean` for every metre up to z1.
struct Prism {
  PolygonWithHoles2 outline;
  double z0_m = 0.0;
  double z1_m = 0.0;
  Eigen::Vector2d lean = Eigen::Vector2d::Zero();
};

/// Representations of one product, gathered.
class ShapeWriter {
 public:
  /// Bodies get the palette's colour of this name, or none.
  explicit ShapeWriter(IfcDocument& document, std::string_view colour = "") : document_(document), colour_(colour) {}

  /// Body of triangles, each solid an item. Nothing without triangles.
  ShapeWriter& body(const std::vector<Solid>& solids);
  /// Body of one extrusion. Nothing where it has no height or no outline.
  ShapeWriter& body(const Prism& prism);
  /// Reference line of a wall.
  ShapeWriter& axis(const Eigen::Vector2d& a, const Eigen::Vector2d& b);
  /// Closed rings: outer first, then holes. Nothing for an empty outline.
  ShapeWriter& footprint(const PolygonWithHoles2& outline);
  /// Number of the IfcProductDefinitionShape, 0 without representations.
  [[nodiscard]] int finish();

 private:
  [[nodiscard]] int polyline(const Polygon2& points, bool closed);
  void represent(int context, const char* name, const char* type, const std::vector<int>& items);

  IfcDocument& document_;
  std::string_view colour_;
  std::vector<int> representations_;
};

}  // namespace plumbline::bim
