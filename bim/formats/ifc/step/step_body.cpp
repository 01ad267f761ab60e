// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_body.h"

#include <ifcpp/IFC4/include/IfcBoundingBox.h>
#include <ifcpp/IFC4/include/IfcCartesianPoint.h>
#include <ifcpp/IFC4/include/IfcLabel.h>
#include <ifcpp/IFC4/include/IfcLengthMeasure.h>
#include <ifcpp/IFC4/include/IfcPositiveLengthMeasure.h>
#include <ifcpp/IFC4/include/IfcProduct.h>
#include <ifcpp/IFC4/include/IfcProductRepresentation.h>
#include <ifcpp/IFC4/include/IfcShapeRepresentation.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "bim/formats/ifc/step/step_parse.h"

namespace plumbline::bim {
namespace {

using Representations = std::vector<std::shared_ptr<IfcRepresentation>>;

/// How well a representation serves as a body: 0 best, nullopt not at all. Old files leave its name out; then its type
/// tells.
std::optional<int> body_rank(const IfcRepresentation& representation, StepClass kind) {
  constexpr std::array<std::string_view, 11> solid_types{
      "AdvancedBrep", "AdvancedSweptSolid", "Brep",       "CSG",          "Clipping",           "MappedRepresentation",
      "SolidModel",   "SurfaceModel",       "SweptSolid", "Tessellation", "SurfaceOrSolidModel"};
  constexpr std::array<std::string_view, 10> others{"Annotation", "Annotation2D", "Axis",    "Box",      "Clearance",
                                                    "CoG",        "FootPrint",    "Profile", "Lighting", "Plan"};
  const auto text = [](const auto& label) { return label ? utf8(label->m_value) : std::string(); };
  const std::string name = text(representation.m_RepresentationIdentifier);
  if (name == "Body") return 0;
  if (name == "Reference") return kind == StepClass::opening ? std::optional(1) : std::nullopt;
  if (std::find(others.begin(), others.end(), name) != others.end()) return std::nullopt;
  const std::string type = text(representation.m_RepresentationType);
  return std::find(solid_types.begin(), solid_types.end(), type) != solid_types.end() ? std::optional(2) : std::nullopt;
}

std::string name_of(const std::shared_ptr<IfcRepresentation>& representation) {
  const bool named = representation && representation->m_RepresentationIdentifier;
  return named ? utf8(representation->m_RepresentationIdentifier->m_value) : std::string();
}

/// Representations that may serve as a body, the best first.
Representations bodies_of(const IfcProduct& source, StepClass kind) {
  std::vector<std::pair<int, std::shared_ptr<IfcRepresentation>>> ranked;
  for (const auto& representation : source.m_Representation->m_Representations) {
    const std::optional<int> rank = representation ? body_rank(*representation, kind) : std::nullopt;
    if (rank) ranked.emplace_back(*rank, representation);
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  Representations bodies;
  for (const auto& [rank, representation] : ranked) bodies.push_back(representation);
  return bodies;
}

}  // namespace

bool has_body(const IfcProduct& source, StepClass kind) {
  return source.m_Representation && !bodies_of(source, kind).empty();
}

void read_outline(const IfcProduct& source, double unit_m, StepValidator& validator, StepGeometry& geometry,
                  StepProduct& product) {
  if (!source.m_Representation) return;
  for (const auto& representation : source.m_Representation->m_Representations) {
    if (name_of(representation) != "FootPrint") continue;
    validator.check(*representation);
    const std::vector<Eigen::Vector3d> curves = geometry.curve(representation, product.diagnostics);
    for (const Eigen::Vector3d& p : curves) {
      if (!product.outline.empty() && p == product.outline.front()) break;
      product.outline.push_back(p);
    }
    if (product.outline.size() >= 3) return;
    product.outline.clear();
  }
  for (const auto& representation : source.m_Representation->m_Representations) {
    if (name_of(representation) != "Box") continue;
    validator.check(*representation);
    for (const auto& item : representation->m_Items) {
      const auto box = std::dynamic_pointer_cast<IfcBoundingBox>(item);
      if (!box || box->m_Corner->m_Coordinates.size() < 3) continue;
      Eigen::Vector3d corner;
      for (int axis = 0; axis < 3; ++axis)
        corner[axis] = unit_m * box->m_Corner->m_Coordinates[static_cast<std::size_t>(axis)]->m_value;
      const double x = unit_m * box->m_XDim->m_value, y = unit_m * box->m_YDim->m_value;
      for (const auto& [dx, dy] : {std::pair(0.0, 0.0), std::pair(x, 0.0), std::pair(x, y), std::pair(0.0, y)})
        product.outline.push_back(corner + Eigen::Vector3d(dx, dy, 0.0));
      return;
    }
  }
}

void read_axis(const IfcProduct& source, StepValidator& validator, StepGeometry& geometry, StepProduct& product) {
  if (!source.m_Representation) return;
  for (const auto& representation : source.m_Representation->m_Representations) {
    if (name_of(representation) != "Axis") continue;
    validator.check(*representation);
    product.axis_W = geometry.curve(representation, product.diagnostics);
    for (Eigen::Vector3d& p : product.axis_W) p = product.X_WP * p;
  }
}

void read_body(const IfcProduct& source, StepValidator& validator, StepGeometry& geometry, StepProduct& product) {
  if (!source.m_Representation) return;
  for (const auto& representation : bodies_of(source, product.kind)) {
    validator.check(*representation);
    product.body = geometry.shapes(representation, product.diagnostics);
    if (!product.body.empty()) return;
  }
}

}  // namespace plumbline::bim
