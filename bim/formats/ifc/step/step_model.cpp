// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_model.h"

#include <ifcpp/IFC4/include/IfcBuilding.h>
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
#include <ifcpp/IFC4/include/IfcSpatialElement.h>
#include <ifcpp/IFC4/include/IfcUnitAssignment.h>
#include <ifcpp/IFC4/include/IfcUnitEnum.h>
#include <ifcpp/IFC4/include/IfcWall.h>
#include <ifcpp/model/BuildingModel.h>
#include <ifcpp/model/UnitConverter.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string_view>

#include "bim/config/tree.h"
#include "bim/errors.h"
#include "bim/formats/ifc/step/georeference.h"
#include "bim/formats/ifc/step/scoped_silence.h"
#include "bim/formats/ifc/step/step_body.h"
#include "bim/formats/ifc/step/step_curves.h"
#include "bim/formats/ifc/step/step_edge_loops.h"
#include "bim/formats/ifc/step/step_entities.h"
#include "bim/formats/ifc/step/step_geometry.h"
#include "bim/formats/ifc/step/step_known_placements.h"
#include "bim/formats/ifc/step/step_material.h"
#include "bim/formats/ifc/step/step_optics.h"
#include "bim/formats/ifc/step/step_parse.h"
#include "bim/formats/ifc/step/step_placement.h"
#include "bim/formats/ifc/step/step_plain_shapes.h"
#include "bim/formats/ifc/step/step_repair.h"
#include "bim/formats/ifc/step/step_said.h"
#include "bim/formats/ifc/step/step_units.h"
#include "bim/formats/ifc/step/step_validator.h"
#include "bim/model/building_sizes.h"

namespace plumbline::bim {
namespace {

/// Class of a product; an element of a type that has no own is in the way.
std::optional<StepClass> class_of_product(const IfcProduct& product) {
  if (is_provision(product)) return StepClass::hidden;
  if (const std::optional<StepClass> known = class_of(product.className())) return known;
  if (dynamic_cast<const IfcElement*>(&product) == nullptr) return std::nullopt;
  return dynamic_cast<const IfcFeatureElementSubtraction*>(&product) != nullptr ? StepClass::opening
                                                                                : StepClass::obstacle;
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

/// What spaces and storeys are contained in, by STEP number; the schema has them aggregated instead.
using Containers = std::map<std::int64_t, std::shared_ptr<IfcProduct>>;

Containers containers_of(const BuildingModel& model) {
  Containers containers;
  for (const auto& [step_id, entity] : model.getMapIfcEntities()) {
    const auto relation = std::dynamic_pointer_cast<IfcRelContainedInSpatialStructure>(entity);
    if (!relation || !relation->m_RelatingStructure) continue;
    for (const auto& part : relation->m_RelatedElements)
      if (std::dynamic_pointer_cast<IfcSpatialElement>(part))
        containers.try_emplace(part->m_entity_id, relation->m_RelatingStructure);
  }
  return containers;
}

/// By what it hangs on, `contained` also by what it is contained in; that goes first.
std::int64_t storey_of(std::shared_ptr<IfcProduct> product, const Containers& contained) {
  constexpr int most_steps = 12;  // window, opening, wall, ... storey; more is a loop of relations
  for (int step = 0; product && step < most_steps; ++step) {
    if (std::dynamic_pointer_cast<IfcBuildingStorey>(product)) return product->m_entity_id;
    const auto in = contained.find(product->m_entity_id);
    product = in != contained.end() ? in->second : parent_of(product);
  }
  return 0;
}

std::shared_ptr<IfcBuilding> building_of(std::shared_ptr<IfcProduct> storey) {
  constexpr int most_steps = 12;
  for (int step = 0; storey && step < most_steps; ++step) {
    if (const auto building = std::dynamic_pointer_cast<IfcBuilding>(storey)) return building;
    storey = parent_of(storey);
  }
  return nullptr;
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

std::int64_t whole_of(const IfcProduct& product) {
  for (const auto& link : product.m_Decomposes_inverse) {
    const auto relation = link.lock();
    const auto whole = relation ? std::dynamic_pointer_cast<IfcProduct>(relation->m_RelatingObject) : nullptr;
    if (whole) return whole->m_entity_id;
  }
  return 0;
}

/// Doors and windows are known by their openings in walls; others are located by their body alone.
bool needs_geometry(const std::shared_ptr<IfcProduct>& source, StepClass kind) {
  if (kind == StepClass::storey || kind == StepClass::hidden) return false;
  if (kind != StepClass::door && kind != StepClass::window) return true;
  const auto opening = std::dynamic_pointer_cast<IfcFeatureElementSubtraction>(parent_of(source));
  return !opening || !opening->m_Representation || !std::dynamic_pointer_cast<IfcWall>(parent_of(opening));
}

bool has_length_unit(const IfcProject& project) {
  if (!project.m_UnitsInContext) return false;
  const auto& units = project.m_UnitsInContext->m_Units;
  return std::any_of(units.begin(), units.end(), [](const auto& select) {
    const auto unit = std::dynamic_pointer_cast<IfcNamedUnit>(select);
    return unit && unit->m_UnitType && unit->m_UnitType->m_enum == IfcUnitEnum::ENUM_LENGTHUNIT;
  });
}

class Reader {
 public:
  /// `bounded`: products out of reach are left out.
  Reader(const std::shared_ptr<BuildingModel>& model, const StepText& checked, const std::string& file, bool bounded)
      : model_(model),
        validator_(checked, file),
        geometry_(model),
        contained_(containers_of(*model)),
        checked_(checked),
        file_(file),
        bounded_(bounded) {}

  StepModel read() {
    StepModel result;
    const std::shared_ptr<IfcProject> project = model_->getIfcProject();
    result.name = project && project->m_Name ? utf8(project->m_Name->m_value) : std::string();
    result.unit_m = model_->getUnitConverter()->getLengthInMeterFactor();
    result.optics = read_optics(*model_);
    for (const auto& [step_id, entity] : model_->getMapIfcEntities()) {
      const auto product = std::dynamic_pointer_cast<IfcProduct>(entity);
      const std::optional<StepClass> kind = product ? class_of_product(*product) : std::nullopt;
      if (!kind) continue;
      if (std::optional<StepProduct> read = try_product(product, *kind, result)) {
        result.products.push_back(std::move(*read));
      }
    }
    name_apart(result);
    std::sort(result.products.begin(), result.products.end(),
              [](const StepProduct& a, const StepProduct& b) { return a.id < b.id; });
    check_wholes(result.products);
    return result;
  }

 private:
  /// A part of itself, by relations that each make sense, would keep everything that follows wholes busy for ever.
  void check_wholes(const std::vector<StepProduct>& products) const {
    constexpr int most_deep = 100;
    std::map<std::int64_t, std::int64_t> whole;
    for (const StepProduct& product : products) whole[product.step_id] = product.whole;
    for (const StepProduct& product : products) {
      int depth = 0;
      for (auto at = whole.find(product.whole); at != whole.end(); at = whole.find(at->second))
        if (++depth > most_deep)
          fail(product.step_id, product.type + " is a part of itself, or of more than " + std::to_string(most_deep) +
                                    " wholes in each other");
    }
  }

  static std::string title(const IfcProduct& source) {
    return source.className() + std::string(" #") + std::to_string(source.m_entity_id);
  }

  /// Products without a GlobalId get one of their number; of those that share one all but the first get theirs too.
  static void name_apart(StepModel& model) {
    std::sort(model.products.begin(), model.products.end(),
              [](const StepProduct& a, const StepProduct& b) { return a.step_id < b.step_id; });
    std::set<std::string> used;
    for (StepProduct& product : model.products) {
      const std::string given = product.id;
      if (!given.empty() && used.insert(given).second) continue;
      product.id = (given.empty() ? "" : given + "/") + std::string("#") + std::to_string(product.step_id);
      used.insert(product.id);
      model.skipped.push_back({product.id, "no_global_id",
                               product.type + " #" + std::to_string(product.step_id) +
                                   (given.empty() ? ": has no GlobalId" : ": shares its GlobalId with another") +
                                   "; its number names it"});
    }
  }

  /// Nullopt, with a warning, for a product that makes no sense.
  std::optional<StepProduct> try_product(const std::shared_ptr<IfcProduct>& source, StepClass kind, StepModel& model) {
    const std::string id = source->m_GlobalId ? utf8(source->m_GlobalId->m_value) : std::string();
    if (const std::int64_t missing = checked_.missing(source->m_entity_id); missing != 0) {
      model.skipped.push_back({id, "dangling",
                               title(*source) + ": depends on #" + std::to_string(missing) +
                                   ", which is not in the file, and is left out"});
      return std::nullopt;
    }
    try {
      return read_product(source, kind, model);
    } catch (const InputError& error) {
      model.skipped.push_back({id, "makes_no_sense", title(*source) + ": is left out: " + error.what()});
      return std::nullopt;
    }
  }

  /// Nullopt, with a warning, for a product whose placement cannot be resolved. Throws InputError for one that makes no
  /// sense.
  std::optional<StepProduct> read_product(const std::shared_ptr<IfcProduct>& source, StepClass kind, StepModel& model) {
    StepProduct product;
    product.step_id = source->m_entity_id;
    product.kind = kind;
    product.type = source->className();
    product.id = source->m_GlobalId ? utf8(source->m_GlobalId->m_value) : std::string();
    const ProductPose pose = placement(source->m_ObjectPlacement, model.unit_m);
    if (!pose.fault.empty()) fail(product.step_id, product.type + " " + pose.fault);
    if (!pose.X_WP) {
      model.skipped.push_back({product.id, "skipped_placement",
                               product.type + " #" + std::to_string(product.step_id) +
                                   ": stands on a grid or an alignment that cannot be evaluated, and is left out"});
      return std::nullopt;
    }
    product.placed = source->m_ObjectPlacement != nullptr;
    product.X_WP = *pose.X_WP;
    product.storey = storey_of(source, {});
    if (product.storey == 0) product.storey = storey_of(source, contained_);
    product.host = host_of(source, kind);
    product.whole = whole_of(*source);
    read_said(*source, model.unit_m, product);
    if (const auto building = kind == StepClass::storey ? building_of(source) : nullptr) {
      product.building = building->m_entity_id;
      product.building_name = building->m_Name ? utf8(building->m_Name->m_value) : std::string();
    }
    read_material(*source, model.unit_m, product);
    if (source->m_Representation) read_geometry(source, model.unit_m, product);
    if (bounded_ && !within_reach(product)) {
      ++model.out_of_reach;
      fail(product.step_id, product.type + (is_finite(product) ? " is larger than 10 km or further than 100000 km"
                                                               : " has coordinates that are not numbers"));
    }
    return product;
  }

  void read_geometry(const std::shared_ptr<IfcProduct>& source, double unit_m, StepProduct& product) {
    product.has_body = has_body(*source, product.kind);
    if (product.kind == StepClass::wall) try_axis(*source, product);
    if (needs_geometry(source, product.kind)) read_body(*source, validator_, geometry_, product);
    if (product.kind == StepClass::space && product.body.empty()) try_outline(*source, unit_m, product);
  }

  /// A wall without its Axis is located by its body.
  void try_axis(const IfcProduct& source, StepProduct& product) {
    try {
      read_axis(source, validator_, geometry_, product);
    } catch (const InputError& error) {
      product.axis_W.clear();
      product.diagnostics.push_back(std::string("its axis is left out: ") + error.what());
    }
  }

  /// A space without an outline has no name for the room that its walls enclose.
  void try_outline(const IfcProduct& source, double unit_m, StepProduct& product) {
    try {
      read_outline(source, unit_m, validator_, geometry_, product);
    } catch (const InputError& error) {
      product.outline.clear();
      product.diagnostics.push_back(std::string("its outline is left out: ") + error.what());
    }
  }

  [[noreturn]] void fail(std::int64_t step_id, const std::string& what) const {
    throw InputError({file_, checked_.line(step_id), 0}, "#" + std::to_string(step_id) + ": " + what);
  }

  std::shared_ptr<BuildingModel> model_;
  StepValidator validator_;
  StepGeometry geometry_;
  Containers contained_;
  const StepText& checked_;
  const std::string& file_;
  bool bounded_;
};

/// The length of the file's unit, m, where the file does not give it: what is too large in metres and a building in
/// millimetres is in these. Says so in `warnings`.
double assumed_unit(const StepModel& in_metres, std::vector<Warning>& warnings) {
  constexpr double most_m = 1000.0, millimetre = 0.001;
  const Eigen::Vector3d sizes = extent_of_building(in_metres);
  const double size = std::round(sizes.maxCoeff());
  if (size <= most_m || !BuildingSizes{.largest_m = 5.0 * most_m, .shortest_m = 2.0}.hold(millimetre * sizes)) {
    warnings.push_back({"", "assumed_unit", "the file gives no unit; metres assumed"});
    return 1.0;
  }
  warnings.push_back({"", "assumed_unit",
                      "the file gives no unit; it is " + format_number(size) +
                          " m large if that is the metre, and is taken as drawn in millimetres"});
  return millimetre;
}

/// IFC++ takes no heed of the prefix of what a unit is converted to.
void set_converted_length(BuildingModel& model, const StepEntities& entities) {
  constexpr double rounding = 1e-9;
  const std::shared_ptr<UnitConverter>& converter = model.getUnitConverter();
  const std::optional<double> unit_m = assigned_unit(entities, "LENGTHUNIT");
  if (unit_m && std::abs(converter->getLengthInMeterFactor() - *unit_m) > rounding * *unit_m)
    converter->setLengthInMeterFactor(*unit_m);
}

/// Classes that IFC++ does not know, which it leaves out without a word.
void warn_of_unknown(const BuildingModel& model, const std::string& text, const std::string& file, StepModel& result) {
  const auto& known = model.getMapIfcEntities();
  const StepEntities entities(text, file);
  std::map<std::string, int> unknown;
  for (const StepEntities::Entity& entity : entities.all())
    if (!known.contains(static_cast<int>(entity.number))) ++unknown[std::string(entity.type)];
  for (const auto& [type, count] : unknown)
    result.skipped.push_back(
        {"", "unknown_class",
         std::to_string(count) + " of the class " + type + (count == 1 ? " is" : " are") + " not read"});
}

}  // namespace

StepModel read_step_model(const std::string& text, const StepText& checked, const std::string& file) {
  const ScopedSilence quiet;
  const std::string known = with_known_classes(without_dangling(text, checked, file), checked, file);
  const std::string whole = with_plain_shapes(with_plain_loops(with_plain_curves(known, file), file), file);
  const std::shared_ptr<BuildingModel> model = parse_step(with_known_placements(whole, file), checked.schema, file);
  const std::shared_ptr<IfcProject> project = model->getIfcProject();
  std::vector<Warning> assumed;
  if (!project || !has_length_unit(*project))
    model->getUnitConverter()->setLengthInMeterFactor(
        assumed_unit(Reader(model, checked, file, false).read(), assumed));
  set_converted_length(*model, StepEntities(whole, file));
  StepModel result = Reader(model, checked, file, true).read();
  result.skipped.insert(result.skipped.end(), assumed.begin(), assumed.end());
  warn_of_unknown(*model, whole, file, result);
  if (!checked.dangling.empty()) {
    const auto& [number, target] = checked.dangling.front();
    result.skipped.push_back({"", "dangling",
                              "line " + std::to_string(checked.line(number)) + ": #" + std::to_string(number) +
                                  " refers to #" + std::to_string(target) + ", which is not in the file; " +
                                  std::to_string(checked.dangling.size()) +
                                  (checked.dangling.size() == 1 ? " such reference" : " such references") + " in all"});
  }
  result.move = move_to_origin(result);
  return result;
}

}  // namespace plumbline::bim
