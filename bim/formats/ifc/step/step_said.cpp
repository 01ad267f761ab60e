// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_said.h"

#include <ifcpp/IFC4/include/IfcBuildingStorey.h>
#include <ifcpp/IFC4/include/IfcCovering.h>
#include <ifcpp/IFC4/include/IfcCoveringTypeEnum.h>
#include <ifcpp/IFC4/include/IfcDoor.h>
#include <ifcpp/IFC4/include/IfcLabel.h>
#include <ifcpp/IFC4/include/IfcLengthMeasure.h>
#include <ifcpp/IFC4/include/IfcPositiveLengthMeasure.h>
#include <ifcpp/IFC4/include/IfcProduct.h>
#include <ifcpp/IFC4/include/IfcSpace.h>
#include <ifcpp/IFC4/include/IfcSpaceTypeEnum.h>
#include <ifcpp/IFC4/include/IfcWindow.h>

#include "bim/formats/ifc/step/step_parse.h"

namespace plumbline::bim {
namespace {

bool is_ceiling(const IfcProduct& product) {
  const auto* covering = dynamic_cast<const IfcCovering*>(&product);
  return covering != nullptr && covering->m_PredefinedType &&
         covering->m_PredefinedType->m_enum == IfcCoveringTypeEnum::ENUM_CEILING;
}

SpaceUse use_of(const IfcProduct& product) {
  const auto* space = dynamic_cast<const IfcSpace*>(&product);
  if (space == nullptr || !space->m_PredefinedType) return SpaceUse::room;
  switch (space->m_PredefinedType->m_enum) {
    case IfcSpaceTypeEnum::ENUM_GFA:
      return SpaceUse::gross;
    case IfcSpaceTypeEnum::ENUM_EXTERNAL:
      return SpaceUse::outside;
    default:
      return SpaceUse::room;
  }
}

/// Rooms have a number for a name and say what they are in the long name: "Kitchen A102".
std::string name_of(const IfcProduct& source) {
  const std::string name = source.m_Name ? utf8(source.m_Name->m_value) : std::string();
  const auto* space = dynamic_cast<const IfcSpace*>(&source);
  if (space == nullptr || !space->m_LongName) return name;
  const std::string long_name = utf8(space->m_LongName->m_value);
  return name.empty() || name == long_name ? long_name : long_name + " " + name;
}

template <class Filling>
void read_size(const IfcProduct& source, double unit_m, StepProduct& product) {
  const auto* filling = dynamic_cast<const Filling*>(&source);
  if (filling == nullptr) return;
  if (filling->m_OverallWidth) product.width_m = unit_m * filling->m_OverallWidth->m_value;
  if (filling->m_OverallHeight) product.height_m = unit_m * filling->m_OverallHeight->m_value;
}

}  // namespace

void read_said(const IfcProduct& source, double unit_m, StepProduct& product) {
  product.name = name_of(source);
  product.ceiling = is_ceiling(source);
  product.space_use = use_of(source);
  const auto* storey = dynamic_cast<const IfcBuildingStorey*>(&source);
  if (storey != nullptr && storey->m_Elevation) product.elevation_m = unit_m * storey->m_Elevation->m_value;
  read_size<IfcDoor>(source, unit_m, product);
  read_size<IfcWindow>(source, unit_m, product);
}

}  // namespace plumbline::bim
