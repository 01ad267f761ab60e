// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_said.h"

#include <ifcpp/IFC4/include/IfcBuildingElementProxy.h>
#include <ifcpp/IFC4/include/IfcBuildingElementProxyTypeEnum.h>
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

#include <cctype>

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

/// IFC2x3 has no such type of a proxy: it stands in the type that a user defines.
bool says_provision(const IfcBuildingElementProxy& proxy) {
  if (!proxy.m_ObjectType) return false;
  std::string said;
  for (const char c : utf8(proxy.m_ObjectType->m_value))
    if (const auto letter = static_cast<unsigned char>(c); std::isalpha(letter) != 0)
      said += static_cast<char>(std::tolower(letter));
  return said == "provisionforvoid" || said == "provisionforspace";
}

}  // namespace

bool is_provision(const IfcProduct& product) {
  const auto* proxy = dynamic_cast<const IfcBuildingElementProxy*>(&product);
  if (proxy == nullptr) return false;
  if (!proxy->m_PredefinedType) return says_provision(*proxy);
  const auto type = proxy->m_PredefinedType->m_enum;
  return type == IfcBuildingElementProxyTypeEnum::ENUM_PROVISIONFORVOID ||
         type == IfcBuildingElementProxyTypeEnum::ENUM_PROVISIONFORSPACE || says_provision(*proxy);
}

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
