// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_optics.h"

#include <ifcpp/IFC4/include/IfcIdentifier.h>
#include <ifcpp/IFC4/include/IfcLabel.h>
#include <ifcpp/IFC4/include/IfcMaterial.h>
#include <ifcpp/IFC4/include/IfcMaterialProperties.h>
#include <ifcpp/IFC4/include/IfcPropertySingleValue.h>
#include <ifcpp/IFC4/include/IfcRatioMeasure.h>
#include <ifcpp/IFC4/include/IfcReal.h>
#include <ifcpp/model/BuildingModel.h>

#include <optional>

#include "bim/formats/ifc/step/step_parse.h"

namespace plumbline::bim {
namespace {

std::optional<double> share_of(const IfcPropertySingleValue& property) {
  double value = -1.0;
  if (const auto real = std::dynamic_pointer_cast<IfcReal>(property.m_NominalValue)) value = real->m_value;
  if (const auto ratio = std::dynamic_pointer_cast<IfcRatioMeasure>(property.m_NominalValue)) value = ratio->m_value;
  return value >= 0.0 && value <= 1.0 ? std::optional(value) : std::nullopt;
}

/// True where the property is one of light and has a share.
bool take(const IfcPropertySingleValue& property, Material& material) {
  const std::string name = property.m_Name ? utf8(property.m_Name->m_value) : std::string();
  const std::optional<double> share = share_of(property);
  if (!share) return false;
  if (name == "Reflectivity") material.reflectivity = *share;
  if (name == "Transmission") material.transmission = *share;
  if (name == "Specular") material.specular = *share;
  if (name == "Retro") material.retro = *share;
  return name == "Reflectivity" || name == "Transmission" || name == "Specular" || name == "Retro";
}

}  // namespace

std::map<std::string, Material> read_optics(const BuildingModel& model) {
  std::map<std::string, Material> optics;
  for (const auto& [step_id, entity] : model.getMapIfcEntities()) {
    const auto properties = std::dynamic_pointer_cast<IfcMaterialProperties>(entity);
    const auto source = properties ? std::dynamic_pointer_cast<IfcMaterial>(properties->m_Material) : nullptr;
    if (!source || !source->m_Name) continue;
    const std::string name = utf8(source->m_Name->m_value);
    const auto known = optics.find(name);
    Material material = known == optics.end() ? Material{name} : known->second;
    bool found = false;
    for (const auto& property : properties->m_Properties)
      if (const auto single = std::dynamic_pointer_cast<IfcPropertySingleValue>(property))
        found = take(*single, material) || found;
    if (found) optics[name] = material;
  }
  return optics;
}

}  // namespace plumbline::bim
