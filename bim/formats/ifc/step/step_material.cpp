// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_material.h"

#include <ifcpp/IFC4/include/IfcDirectionSenseEnum.h>
#include <ifcpp/IFC4/include/IfcLabel.h>
#include <ifcpp/IFC4/include/IfcLayerSetDirectionEnum.h>
#include <ifcpp/IFC4/include/IfcLengthMeasure.h>
#include <ifcpp/IFC4/include/IfcMaterial.h>
#include <ifcpp/IFC4/include/IfcMaterialConstituent.h>
#include <ifcpp/IFC4/include/IfcMaterialConstituentSet.h>
#include <ifcpp/IFC4/include/IfcMaterialLayer.h>
#include <ifcpp/IFC4/include/IfcMaterialLayerSet.h>
#include <ifcpp/IFC4/include/IfcMaterialLayerSetUsage.h>
#include <ifcpp/IFC4/include/IfcMaterialList.h>
#include <ifcpp/IFC4/include/IfcMaterialProfile.h>
#include <ifcpp/IFC4/include/IfcMaterialProfileSet.h>
#include <ifcpp/IFC4/include/IfcMaterialProfileSetUsage.h>
#include <ifcpp/IFC4/include/IfcMaterialSelect.h>
#include <ifcpp/IFC4/include/IfcNonNegativeLengthMeasure.h>
#include <ifcpp/IFC4/include/IfcNormalisedRatioMeasure.h>
#include <ifcpp/IFC4/include/IfcProduct.h>
#include <ifcpp/IFC4/include/IfcRelAssociatesMaterial.h>
#include <ifcpp/IFC4/include/IfcRelDefinesByType.h>
#include <ifcpp/IFC4/include/IfcTypeObject.h>

#include <set>

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

/// Of the constituent with the largest share; of equal ones, as where no share is given, the first.
std::string material_of(const IfcMaterialConstituentSet& set) {
  double largest = -1.0;
  std::string name;
  for (const auto& constituent : set.m_MaterialConstituents) {
    const double share = constituent && constituent->m_Fraction ? constituent->m_Fraction->m_value : 0.0;
    if (!constituent || share <= largest) continue;
    largest = share;
    name = name_of(constituent->m_Material);
  }
  return name;
}

std::string material_of(const IfcMaterialProfileSet& set) {
  for (const auto& profile : set.m_MaterialProfiles)
    if (profile && profile->m_Material) return name_of(profile->m_Material);
  return {};
}

/// A list of several does not say which of them is where.
std::string material_of(const IfcMaterialList& list) {
  std::set<std::string> names;
  for (const auto& material : list.m_Materials) names.insert(name_of(material));
  return names.size() == 1 ? *names.begin() : std::string();
}

/// The one material of what a relation associates.
std::string material_of(const std::shared_ptr<IfcMaterialSelect>& select) {
  if (const auto usage = std::dynamic_pointer_cast<IfcMaterialLayerSetUsage>(select))
    return usage->m_ForLayerSet ? material_of(*usage->m_ForLayerSet) : std::string();
  if (const auto usage = std::dynamic_pointer_cast<IfcMaterialProfileSetUsage>(select))
    return usage->m_ForProfileSet ? material_of(*usage->m_ForProfileSet) : std::string();
  if (const auto set = std::dynamic_pointer_cast<IfcMaterialLayerSet>(select)) return material_of(*set);
  if (const auto set = std::dynamic_pointer_cast<IfcMaterialProfileSet>(select)) return material_of(*set);
  if (const auto set = std::dynamic_pointer_cast<IfcMaterialConstituentSet>(select)) return material_of(*set);
  if (const auto layer = std::dynamic_pointer_cast<IfcMaterialLayer>(select)) return name_of(layer->m_Material);
  if (const auto profile = std::dynamic_pointer_cast<IfcMaterialProfile>(select)) return name_of(profile->m_Material);
  if (const auto part = std::dynamic_pointer_cast<IfcMaterialConstituent>(select)) return name_of(part->m_Material);
  if (const auto list = std::dynamic_pointer_cast<IfcMaterialList>(select)) return material_of(*list);
  return name_of(std::dynamic_pointer_cast<IfcMaterial>(select));
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

std::vector<std::shared_ptr<IfcMaterialSelect>> materials_of(const IfcObjectDefinition& source) {
  std::vector<std::shared_ptr<IfcMaterialSelect>> materials;
  for (const auto& link : source.m_HasAssociations_inverse)
    if (const auto relation = std::dynamic_pointer_cast<IfcRelAssociatesMaterial>(link.lock()))
      materials.push_back(relation->m_RelatingMaterial);
  return materials;
}

}  // namespace

void read_material(const IfcProduct& source, double unit_m, StepProduct& product) {
  for (const auto& select : materials_of(source)) {
    if (const auto usage = std::dynamic_pointer_cast<IfcMaterialLayerSetUsage>(select))
      product.layers = layers_of(*usage, unit_m);
    if (const std::string name = material_of(select); !name.empty()) product.material = name;
  }
  if (!product.material.empty()) return;
  for (const auto& link : source.m_IsTypedBy_inverse) {
    const auto relation = link.lock();
    if (!relation || !relation->m_RelatingType) continue;
    for (const auto& select : materials_of(*relation->m_RelatingType))
      if (const std::string name = material_of(select); !name.empty()) product.material = name;
  }
}

}  // namespace plumbline::bim
