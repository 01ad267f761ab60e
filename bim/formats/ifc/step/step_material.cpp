// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_material.h"

#include <ifcpp/IFC4/include/IfcDirectionSenseEnum.h>
#include <ifcpp/IFC4/include/IfcLabel.h>
#include <ifcpp/IFC4/include/IfcLayerSetDirectionEnum.h>
#include <ifcpp/IFC4/include/IfcLengthMeasure.h>
#include <ifcpp/IFC4/include/IfcMaterial.h>
#include <ifcpp/IFC4/include/IfcMaterialLayer.h>
#include <ifcpp/IFC4/include/IfcMaterialLayerSet.h>
#include <ifcpp/IFC4/include/IfcMaterialLayerSetUsage.h>
#include <ifcpp/IFC4/include/IfcNonNegativeLengthMeasure.h>
#include <ifcpp/IFC4/include/IfcProduct.h>
#include <ifcpp/IFC4/include/IfcRelAssociatesMaterial.h>

#include "bim/formats/ifc/step/step_parse.h"

namespace plumbline::bim {
namespace {

std::string name_of(const std::shared_ptr<IfcMaterial>& material) {
  return material && material->m_Name ? utf8(material->m_Name->m_value) : std::string();
}

double thickness_of(const std::shared_ptr<IfcMaterialLayer>& layer) {
  return layer && layer->m_LayerThickness ? layer->m_LayerThickness->m_value : 0.0;
}

/// Material of the thickest layer; of equal ones the first.
std::string material_of(const IfcMaterialLayerSet& set) {
  double thickest = 0.0;
  std::string name;
  for (const auto& layer : set.m_MaterialLayers) {
    if (thickness_of(layer) <= thickest) continue;
    thickest = thickness_of(layer);
    name = name_of(layer->m_Material);
  }
  return name;
}

std::optional<StepLayers> layers_of(const IfcMaterialLayerSetUsage& usage, double unit_m) {
  const bool across =
      usage.m_LayerSetDirection && usage.m_LayerSetDirection->m_enum == IfcLayerSetDirectionEnum::ENUM_AXIS2;
  if (!across || !usage.m_ForLayerSet || !usage.m_DirectionSense || !usage.m_OffsetFromReferenceLine) {
    return std::nullopt;
  }
  StepLayers layers;
  for (const auto& layer : usage.m_ForLayerSet->m_MaterialLayers) layers.thickness_m += thickness_of(layer) * unit_m;
  layers.offset_m = usage.m_OffsetFromReferenceLine->m_value * unit_m;
  layers.sense = usage.m_DirectionSense->m_enum == IfcDirectionSenseEnum::ENUM_NEGATIVE ? -1 : 1;
  return layers.thickness_m > 0.0 ? std::optional(layers) : std::nullopt;
}

}  // namespace

void read_material(const IfcProduct& source, double unit_m, StepProduct& product) {
  for (const auto& link : source.m_HasAssociations_inverse) {
    const auto relation = std::dynamic_pointer_cast<IfcRelAssociatesMaterial>(link.lock());
    if (!relation) continue;
    const auto& select = relation->m_RelatingMaterial;
    if (const auto usage = std::dynamic_pointer_cast<IfcMaterialLayerSetUsage>(select)) {
      product.layers = layers_of(*usage, unit_m);
      if (usage->m_ForLayerSet) product.material = material_of(*usage->m_ForLayerSet);
    } else if (const auto set = std::dynamic_pointer_cast<IfcMaterialLayerSet>(select)) {
      product.material = material_of(*set);
    } else if (const auto material = std::dynamic_pointer_cast<IfcMaterial>(select)) {
      product.material = name_of(material);
    }
  }
}

}  // namespace plumbline::bim
