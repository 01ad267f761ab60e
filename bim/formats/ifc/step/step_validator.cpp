// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_validator.h"

#include <ifcpp/IFC4/include/IfcMappedItem.h>
#include <ifcpp/IFC4/include/IfcRepresentation.h>
#include <ifcpp/IFC4/include/IfcRepresentationItem.h>
#include <ifcpp/IFC4/include/IfcRepresentationMap.h>
#include <ifcpp/model/AttributeObject.h>
#include <ifcpp/model/BuildingObject.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "bim/errors.h"

namespace plumbline::bim {
namespace {

/// Attributes of geometry that a file may leave open [iso2018, geometry, profile and topology resources]; EdgeStart
/// and EdgeEnd of an oriented edge are derived.
constexpr std::array<std::string_view, 43> optional_attributes{{"Axis",
                                                                "Axis1",
                                                                "Axis2",
                                                                "Axis3",
                                                                "BottomFlangeEdgeRadius",
                                                                "BottomFlangeFilletRadius",
                                                                "BottomFlangeSlope",
                                                                "CentreOfGravityInX",
                                                                "CentreOfGravityInY",
                                                                "Closed",
                                                                "EdgeEnd",
                                                                "EdgeRadius",
                                                                "EdgeStart",
                                                                "EndParam",
                                                                "FilletRadius",
                                                                "FlangeEdgeRadius",
                                                                "FlangeSlope",
                                                                "InnerFilletRadius",
                                                                "InnerRadius",
                                                                "InternalFilletRadius",
                                                                "Label",
                                                                "LegSlope",
                                                                "Normals",
                                                                "OuterFilletRadius",
                                                                "PnIndex",
                                                                "Position",
                                                                "ProfileName",
                                                                "RefDirection",
                                                                "Scale",
                                                                "Scale2",
                                                                "Scale3",
                                                                "Segments",
                                                                "SelfIntersect",
                                                                "StartParam",
                                                                "TagList",
                                                                "TopFlangeEdgeRadius",
                                                                "TopFlangeFilletRadius",
                                                                "TopFlangeSlope",
                                                                "TopFlangeThickness",
                                                                "WebEdgeRadius",
                                                                "WebSlope",
                                                                "WeightsData",
                                                                "Width"}};

bool is_optional(std::string_view name) {
  return std::find(optional_attributes.begin(), optional_attributes.end(), name) != optional_attributes.end();
}

}  // namespace

void StepValidator::fail(const BuildingEntity& entity, const std::string& attribute) const {
  const std::string number = "#" + std::to_string(entity.m_entity_id);
  throw InputError({file_, text_.line(entity.m_entity_id), 0},
                   number + ": " + entity.className() + " needs a " + attribute + " of its proper kind");
}

void StepValidator::check(const BuildingEntity& entity) {
  const int number = entity.m_entity_id;
  if (const auto known = faulty_.find(number); known != faulty_.end()) throw known->second;
  if (!valid_.insert(number).second) return;
  try {
    check_attributes(entity);
  } catch (const InputError& error) {
    valid_.erase(number);
    faulty_.emplace(number, error);
    throw;
  }
}

void StepValidator::check_attributes(const BuildingEntity& entity) {
  if (const auto* map = dynamic_cast<const IfcRepresentationMap*>(&entity)) {
    if (!map->m_MappedRepresentation) fail(entity, "MappedRepresentation");
    check(*map->m_MappedRepresentation);
  }
  if (dynamic_cast<const IfcRepresentation*>(&entity) != nullptr) return;
  std::vector<std::pair<std::string, std::shared_ptr<BuildingObject>>> attributes;
  entity.getAttributes(attributes);
  for (const auto& [name, value] : attributes) {
    if (!value) {
      if (!is_optional(name)) fail(entity, name);
      continue;
    }
    if (const auto child = std::dynamic_pointer_cast<BuildingEntity>(value)) check(*child);
    const auto list = std::dynamic_pointer_cast<AttributeObjectVector>(value);
    if (!list) continue;
    for (const auto& item : list->m_vec) {
      if (!item) fail(entity, name);
      if (const auto child = std::dynamic_pointer_cast<BuildingEntity>(item)) check(*child);
    }
  }
}

void StepValidator::check(const IfcRepresentation& representation) {
  for (const auto& item : representation.m_Items) {
    if (!item) fail(representation, "Items");
    check(*item);
  }
}

}  // namespace plumbline::bim
