// SPDX-License-Identifier: Apache-2.0
#include "bim/ifc/step_model.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wconversion"
#include <ifcpp/IFC4/include/IfcBuildingStorey.h>
#include <ifcpp/IFC4/include/IfcGloballyUniqueId.h>
#include <ifcpp/IFC4/include/IfcLabel.h>
#include <ifcpp/IFC4/include/IfcNamedUnit.h>
#include <ifcpp/IFC4/include/IfcOpeningElement.h>
#include <ifcpp/IFC4/include/IfcProductRepresentation.h>
#include <ifcpp/IFC4/include/IfcProject.h>
#include <ifcpp/IFC4/include/IfcRelAggregates.h>
#include <ifcpp/IFC4/include/IfcRelContainedInSpatialStructure.h>
#include <ifcpp/IFC4/include/IfcRelFillsElement.h>
#include <ifcpp/IFC4/include/IfcRelVoidsElement.h>
#include <ifcpp/IFC4/include/IfcShapeRepresentation.h>
#include <ifcpp/IFC4/include/IfcSpace.h>
#include <ifcpp/IFC4/include/IfcSpatialElement.h>
#include <ifcpp/IFC4/include/IfcUnitAssignment.h>
#include <ifcpp/IFC4/include/IfcUnitEnum.h>
#include <ifcpp/model/BuildingModel.h>
#include <ifcpp/model/UnitConverter.h>
#pragma GCC diagnostic pop

#include <algorithm>
#include <array>

#include "bim/errors.h"
#include "bim/ifc/quiet.h"
#include "bim/ifc/step_geometry.h"
#include "bim/ifc/step_material.h"
#include "bim/ifc/step_parse.h"
#include "bim/ifc/step_placement.h"
#include "bim/ifc/step_sound.h"

namespace plumbline::bim {
namespace {

struct ClassName {
  std::string_view type;
  StepClass kind;
};

/// IFC classes that are read, IFC2X3 and IFC4; subtypes stand by themselves.
constexpr std::array<ClassName, 27> class_names{{
    {"IfcBeam", StepClass::beam},
    {"IfcBeamStandardCase", StepClass::beam},
    {"IfcBuildingElementProxy", StepClass::proxy},
    {"IfcBuildingStorey", StepClass::storey},
    {"IfcColumn", StepClass::column},
    {"IfcColumnStandardCase", StepClass::column},
    {"IfcCovering", StepClass::covering},
    {"IfcDoor", StepClass::door},
    {"IfcDoorStandardCase", StepClass::door},
    {"IfcFooting", StepClass::footing},
    {"IfcFurnishingElement", StepClass::furniture},
    {"IfcFurniture", StepClass::furniture},
    {"IfcMember", StepClass::member},
    {"IfcMemberStandardCase", StepClass::member},
    {"IfcOpeningElement", StepClass::opening},
    {"IfcOpeningStandardCase", StepClass::opening},
    {"IfcPlate", StepClass::plate},
    {"IfcPlateStandardCase", StepClass::plate},
    {"IfcRailing", StepClass::railing},
    {"IfcRoof", StepClass::roof},
    {"IfcSlab", StepClass::slab},
    {"IfcSpace", StepClass::space},
    {"IfcStair", StepClass::stair},
    {"IfcStairFlight", StepClass::stair},
    {"IfcWall", StepClass::wall},
    {"IfcWallStandardCase", StepClass::wall},
    {"IfcWindow", StepClass::window},
}};

std::optional<StepClass> class_of(std::string_view type) {
  for (const ClassName& name : class_names)
    if (name.type == type) return name.kind;
  return std::nullopt;
}

/// What an element hangs on, one step up: container, then filled opening, then voided element, then whole.
std::shared_ptr<IfcProduct> parent_of(const std::shared_ptr<IfcProduct>& product) {
  if (const auto element = std::dynamic_pointer_cast<IfcElement>(product)) {
    for (const auto& link : element->m_ContainedInStructure_inverse)
      if (const auto relation = link.lock()) return relation->m_RelatingStructure;
    for (const auto& link : element->m_FillsVoids_inverse)
      if (const auto relation = link.lock()) return relation->m_RelatingOpeningElement;
  }
  if (const auto opening = std::dynamic_pointer_cast<IfcFeatureElementSubtraction>(product))
    if (const auto relation = opening->m_VoidsElements_inverse.lock()) return relation->m_RelatingBuildingElement;
  for (const auto& link : product->m_Decomposes_inverse)
    if (const auto relation = link.lock()) return std::dynamic_pointer_cast<IfcProduct>(relation->m_RelatingObject);
  return nullptr;
}

std::int64_t storey_of(std::shared_ptr<IfcProduct> product) {
  constexpr int most_steps = 12;  // window, opening, wall, ... storey; more is a loop of relations
  for (int step = 0; product && step < most_steps; ++step) {
    if (std::dynamic_pointer_cast<IfcBuildingStorey>(product)) return product->m_entity_id;
    product = parent_of(product);
  }
  return 0;
}

std::int64_t host_of(const std::shared_ptr<IfcProduct>& product, StepClass kind) {
  if (const auto opening = std::dynamic_pointer_cast<IfcFeatureElementSubtraction>(product)) {
    const auto relation = opening->m_VoidsElements_inverse.lock();
    return relation && relation->m_RelatingBuildingElement ? relation->m_RelatingBuildingElement->m_entity_id : 0;
  }
  const auto element = std::dynamic_pointer_cast<IfcElement>(product);
  if (!element || (kind != StepClass::door && kind != StepClass::window)) return 0;
  for (const auto& link : element->m_FillsVoids_inverse) {
    const auto relation = link.lock();
    if (relation && relation->m_RelatingOpeningElement) return relation->m_RelatingOpeningElement->m_entity_id;
  }
  return 0;
}

std::string identifier(const std::shared_ptr<IfcRepresentation>& representation) {
  return representation && representation->m_RepresentationIdentifier
             ? utf8(representation->m_RepresentationIdentifier->m_value)
             : std::string();
}

/// False where a coordinate is not a number, or further out than any map grid, or a body too large for a building or
/// too far from its placement.
bool within_reach(const StepProduct& product) {
  constexpr double furthest_m = 1e7, largest_m = 1e4;
  Eigen::AlignedBox3d box;
  const auto extend = [&](const std::vector<Eigen::Vector3d>& points) {
    for (const Eigen::Vector3d& p : points) {
      if (!p.allFinite()) return false;
      box.extend(p);
    }
    return true;
  };
  bool finite = extend(product.axis_W) && extend({product.X_WP.translation()});
  for (const Shape& shape : product.body) {
    finite = finite && extend(shape.base.points);
    for (const Facets& cut : shape.minus) finite = finite && extend(cut.points);
  }
  if (!finite) return false;
  return box.isEmpty() || (box.min().cwiseAbs().maxCoeff() <= furthest_m &&
                           box.max().cwiseAbs().maxCoeff() <= furthest_m && box.sizes().maxCoeff() <= largest_m);
}

/// Body items and axis of a product, moved to W. Openings may name their body Reference.
void read_geometry(const IfcProduct& source, StepSoundness& soundness, StepGeometry& geometry, StepProduct& product) {
  if (!source.m_Representation) return;
  for (const auto& representation : source.m_Representation->m_Representations) {
    const std::string what = identifier(representation);
    if (what == "Axis" && product.kind == StepClass::wall) {
      soundness.check(*representation);
      product.axis_W = geometry.curve(representation, product.complaints);
      for (Eigen::Vector3d& p : product.axis_W) p = product.X_WP * p;
    }
    const bool body = what == "Body" || (what == "Reference" && product.kind == StepClass::opening);
    if (!body || !product.body.empty()) continue;
    soundness.check(*representation);
    for (Shape& shape : geometry.shapes(representation, product.complaints)) {
      Shape& moved = product.body.emplace_back();
      moved.base = transformed(product.X_WP, std::move(shape.base));
      for (Facets& cut : shape.minus) moved.minus.push_back(transformed(product.X_WP, std::move(cut)));
    }
  }
}

bool has_length_unit(const IfcProject& project) {
  if (!project.m_UnitsInContext) return false;
  const auto& units = project.m_UnitsInContext->m_Units;
  return std::any_of(units.begin(), units.end(), [](const auto& select) {
    const auto unit = std::dynamic_pointer_cast<IfcNamedUnit>(select);
    return unit && unit->m_UnitType && unit->m_UnitType->m_enum == IfcUnitEnum::ENUM_LENGTHUNIT;
  });
}

/// Doors and windows are known by their openings, furniture is not part of the shell.
bool needs_geometry(StepClass kind) {
  return kind != StepClass::storey && kind != StepClass::door && kind != StepClass::window &&
         kind != StepClass::furniture && kind != StepClass::proxy;
}

class Reader {
 public:
  Reader(const std::shared_ptr<BuildingModel>& model, const StepText& checked, const std::string& file)
      : model_(model), soundness_(checked, file), geometry_(model), checked_(checked), file_(file) {}

  StepModel read() {
    StepModel result;
    const std::shared_ptr<IfcProject> project = model_->getIfcProject();
    if (!project) throw InputError({file_, 0, 0}, "the file has no IfcProject, so nothing says its unit");
    result.name = project->m_Name ? utf8(project->m_Name->m_value) : std::string();
    result.has_unit = has_length_unit(*project);
    result.unit_m = model_->getUnitConverter()->getLengthInMeterFactor();
    for (const auto& [step_id, entity] : model_->getMapIfcEntities()) {
      const auto product = std::dynamic_pointer_cast<IfcProduct>(entity);
      const std::optional<StepClass> kind = product ? class_of(product->className()) : std::nullopt;
      if (kind) result.products.push_back(read_product(product, *kind, result.unit_m));
    }
    std::sort(result.products.begin(), result.products.end(),
              [](const StepProduct& a, const StepProduct& b) { return a.id < b.id; });
    for (std::size_t i = 1; i < result.products.size(); ++i)
      if (result.products[i].id == result.products[i - 1].id)
        fail(result.products[i].step_id, "GlobalId " + result.products[i].id + " is used twice");
    return result;
  }

 private:
  StepProduct read_product(const std::shared_ptr<IfcProduct>& source, StepClass kind, double unit_m) {
    StepProduct product;
    product.step_id = source->m_entity_id;
    product.kind = kind;
    product.type = source->className();
    product.id = source->m_GlobalId ? utf8(source->m_GlobalId->m_value) : std::string();
    if (product.id.empty()) fail(product.step_id, product.type + " has no GlobalId");
    product.name = name_of(*source);
    const std::optional<Eigen::Affine3d> X_WP = placement(source->m_ObjectPlacement, unit_m);
    if (!X_WP) fail(product.step_id, product.type + " has a placement that makes no sense");
    product.X_WP = *X_WP;
    product.storey = kind == StepClass::storey ? product.step_id : storey_of(source);
    product.host = host_of(source, kind);
    read_material(*source, unit_m, product);
    if (needs_geometry(kind)) read_geometry(*source, soundness_, geometry_, product);
    if (!within_reach(product)) fail(product.step_id, product.type + " is larger than 10 km or further than 10000 km");
    return product;
  }

  /// Rooms have a number for a name and say what they are in the long name: "Kitchen A102".
  static std::string name_of(const IfcProduct& source) {
    const std::string name = source.m_Name ? utf8(source.m_Name->m_value) : std::string();
    const auto* space = dynamic_cast<const IfcSpace*>(&source);
    if (space == nullptr || !space->m_LongName) return name;
    const std::string long_name = utf8(space->m_LongName->m_value);
    return name.empty() || name == long_name ? long_name : long_name + " " + name;
  }

  [[noreturn]] void fail(std::int64_t step_id, const std::string& what) const {
    throw InputError({file_, checked_.line(step_id), 0}, "#" + std::to_string(step_id) + ": " + what);
  }

  std::shared_ptr<BuildingModel> model_;
  StepSoundness soundness_;
  StepGeometry geometry_;
  const StepText& checked_;
  const std::string& file_;
};

}  // namespace

StepModel read_step_model(const std::string& text, const StepText& checked, const std::string& file) {
  const Quiet quiet;
  const std::shared_ptr<BuildingModel> model = parse_step(text, file);
  return Reader(model, checked, file).read();
}

}  // namespace plumbline::bim
