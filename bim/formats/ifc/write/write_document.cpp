// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/write/write_document.h"

#include <algorithm>
#include <cmath>

#include "bim/digest/digest.h"
#include "bim/formats/ifc/roundtrip/roundtrip_signature.h"
#include "bim/formats/ifc/step/step_string.h"
#include "bim/formats/ifc/write/global_id.h"
#include "bim/mesh/palette.h"

namespace plumbline::bim {

using step::none;
using step::ref;

namespace {

/// A building has no time: all files are from the beginning of the epoch.
constexpr std::string_view time_stamp = "1970-01-01T00:00:00";
constexpr std::string_view program = "Plumbline";

std::string hashed_id(const std::vector<std::string>& key) {
  const auto half = [&](int salt) {
    Digest digest;
    digest.add(salt);
    for (const std::string& part : key) digest.add(part);
    return digest.value();
  };
  return global_id({half(0), half(1)});
}

std::string header(const std::string& name, const std::string& signature) {
  return "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(('ViewDefinition [DesignTransferView_V1.0]'," +
         step_string(signature) + "),'2;1');\nFILE_NAME(" + step_string(name) + "," + step_string(time_stamp) +
         ",(''),('')," + step_string(program) + "," + step_string(program) + ",'');\nFILE_SCHEMA(('IFC4'));\nENDSEC;\n";
}

}  // namespace

StepProperty length_property(const std::string& name, double value_m) {
  return {name, step::typed("IFCLENGTHMEASURE", step_real(value_m))};
}
StepProperty real_property(const std::string& name, double value) {
  return {name, step::typed("IFCREAL", step_real(value))};
}
StepProperty text_property(const std::string& name, std::string_view text) {
  return {name, step::typed("IFCTEXT", step_string(text))};
}
StepProperty flag_property(const std::string& name, bool value) {
  return {name, step::typed("IFCBOOLEAN", step::boolean(value))};
}

IfcDocument::IfcDocument(const Building& building) : building_name_(building.name) {
  for (const Storey& storey : building.storeys) storey_ids_.push_back(storey.id);
  add_head(building);
  add_storeys(building.storeys);
  add_materials(building);
}

void IfcDocument::add_owner() {
  const int person = step_.add("IFCPERSON", {none, step_string(program), none, none, none, none, none, none});
  const int organization = step_.add("IFCORGANIZATION", {none, step_string(program), none, none, none});
  const int user = step_.add("IFCPERSONANDORGANIZATION", {ref(person), ref(organization), none});
  const int application =
      step_.add("IFCAPPLICATION", {ref(organization), step_string("1"), step_string(program), step_string(program)});
  owner_ = step_.add("IFCOWNERHISTORY", {ref(user), ref(application), none, ".NOCHANGE.", none, none, none, "0"});
}

void IfcDocument::add_contexts(const Building& building) {
  const int origin = step_.add("IFCCARTESIANPOINT", {"(0.,0.,0.)"});
  world_ = step_.add("IFCAXIS2PLACEMENT3D", {ref(origin), none, none});
  context_ = step_.add("IFCGEOMETRICREPRESENTATIONCONTEXT",
                       {none, step_string("Model"), "3", step_real(1e-5), ref(world_), none});
  const auto subcontext = [&](const char* name, const char* view) {
    return step_.add("IFCGEOMETRICREPRESENTATIONSUBCONTEXT",
                     {step_string(name), step_string("Model"), step::inherited, step::inherited, step::inherited,
                      step::inherited, ref(context_), none, step::enumeration(view), none});
  };
  body_context_ = subcontext("Body", "MODEL_VIEW");
  axis_context_ = subcontext("Axis", "GRAPH_VIEW");
  footprint_context_ = subcontext("FootPrint", "PLAN_VIEW");
  if (building.moved_by) add_map_conversion(*building.moved_by);
}

void IfcDocument::add_map_conversion(const Eigen::Vector3d& moved_by) {
  const int map =
      step_.add("IFCPROJECTEDCRS", {step_string("map of the file read"), none, none, none, none, none, none});
  step_.add("IFCMAPCONVERSION", {ref(context_), ref(map), step_real(-moved_by.x()), step_real(-moved_by.y()),
                                 step_real(-moved_by.z()), step_real(1.0), step_real(0.0), step_real(1.0)});
}

int IfcDocument::add_units() {
  std::vector<int> units;
  for (const auto& [what, name] : {std::pair{"LENGTHUNIT", "METRE"},
                                   {"AREAUNIT", "SQUARE_METRE"},
                                   {"VOLUMEUNIT", "CUBIC_METRE"},
                                   {"PLANEANGLEUNIT", "RADIAN"}})
    units.push_back(step_.add("IFCSIUNIT", {step::inherited, step::enumeration(what), none, step::enumeration(name)}));
  return step_.add("IFCUNITASSIGNMENT", {step::refs(units)});
}

void IfcDocument::add_head(const Building& building) {
  add_owner();
  add_contexts(building);
  const int assignment = add_units();
  const int project =
      step_.add("IFCPROJECT", {step_string(new_id({"project", "", "", -1})), ref(owner_), step_string(building.name),
                               none, none, none, none, step::refs({context_}), ref(assignment)});
  const int site_placement = step_.add("IFCLOCALPLACEMENT", {none, ref(world_)});
  const int site = step_.add("IFCSITE", {step_string(new_id({"site", "", "", -1})), ref(owner_), none, none, none,
                                         ref(site_placement), none, none, ".ELEMENT.", none, none, none, none, none});
  building_placement_ = add_placement(site_placement);
  building_ =
      step_.add("IFCBUILDING", {step_string(new_id({"building", "", "", -1})), ref(owner_), step_string(building.name),
                                none, none, ref(building_placement_), none, none, ".ELEMENT.", none, none, none});
  relate("IFCRELAGGREGATES", {ref(project), step::refs({site})});
  relate("IFCRELAGGREGATES", {ref(site), step::refs({building_})});
}

void IfcDocument::add_storeys(const std::vector<Storey>& storeys) {
  for (const Storey& storey : storeys) {
    const int corner =
        step_.add("IFCCARTESIANPOINT", {step::list({step_real(0.0), step_real(0.0), step_real(storey.elevation_m)})});
    const int axes = step_.add("IFCAXIS2PLACEMENT3D", {ref(corner), none, none});
    const int placement = step_.add("IFCLOCALPLACEMENT", {ref(building_placement_), ref(axes)});
    const std::string id = new_id({"storey", storey.id, "", -1});
    const int number =
        step_.add("IFCBUILDINGSTOREY", {step_string(id), ref(owner_), step_string(storey.name), none, none,
                                        ref(placement), none, none, ".ELEMENT.", step_real(storey.elevation_m)});
    ids_[number] = id;
    storeys_.push_back(number);
    add_properties(number, "Plumbline_Storey",
                   {text_property("Id", storey.id), length_property("Height", storey.height_m),
                    text_property("Kind", name_of(storey.kind))});
  }
  if (!storeys_.empty()) relate("IFCRELAGGREGATES", {ref(building_), step::refs(storeys_)});
}

void IfcDocument::add_materials(const Building& building) {
  for (const Material& material : building.materials) add_material(&material, material.id);
  const auto add_name = [&](const std::string& name) {
    if (!name.empty() && !materials_.contains(name)) add_material(nullptr, name);
  };
  for (const Wall& wall : building.walls) add_name(wall.material);
  for (const Opening& opening : building.openings) add_name(opening.material);
  for (const Slab& slab : building.slabs) add_name(slab.material);
  for (const Column& column : building.columns) add_name(column.material);
  for (const Stair& stair : building.stairs) add_name(stair.material);
  for (const Obstacle& obstacle : building.obstacles) add_name(obstacle.material);
}

void IfcDocument::add_material(const Material* optics, const std::string& name) {
  const int number = step_.add("IFCMATERIAL", {step_string(name), none, none});
  materials_.try_emplace(name, number);
  if (optics == nullptr) return;
  std::vector<int> values;
  for (const auto& [key, value] : {std::pair{"Reflectivity", optics->reflectivity},
                                   {"Transmission", optics->transmission},
                                   {"Specular", optics->specular},
                                   {"Retro", optics->retro}})
    values.push_back(
        step_.add("IFCPROPERTYSINGLEVALUE",
                  {step_string(key), none, step::typed("IFCNORMALISEDRATIOMEASURE", step_real(value)), none}));
  step_.add("IFCMATERIALPROPERTIES", {step_string("Plumbline_Optics"), none, step::refs(values), ref(number)});
}

void IfcDocument::assign_colour(int item, std::string_view name) {
  const auto all = palette();
  const auto known = std::find_if(all.begin(), all.end(), [&](const Colour& colour) { return colour.name == name; });
  if (known == all.end()) return;
  if (!styles_.contains(name)) {
    // IFC's colours are those of a screen, whose curve is close to a square root.
    const auto shown = [](float linear) { return step_real(std::sqrt(static_cast<double>(linear))); };
    const int colour = step_.add("IFCCOLOURRGB", {none, shown(known->red), shown(known->green), shown(known->blue)});
    const int shading =
        step_.add("IFCSURFACESTYLERENDERING", {ref(colour), step_real(1.0 - static_cast<double>(known->opacity)), none,
                                               none, none, none, none, none, ".NOTDEFINED."});
    styles_[std::string(name)] = step_.add("IFCSURFACESTYLE", {step_string(name), ".BOTH.", step::refs({shading})});
  }
  step_.add("IFCSTYLEDITEM", {ref(item), step::refs({styles_.find(name)->second}), none});
}

std::string IfcDocument::new_id(const ProductText& text) {
  if (global_id_bits(text.id) && used_ids_.insert(text.id).second) return text.id;
  const std::string storey = text.storey >= 0 ? storey_ids_.at(static_cast<std::size_t>(text.storey)) : "";
  std::vector<std::string> key{building_name_, text.kind, storey, text.id};
  // Ids may be shared: an opening through two walls is two openings here.
  for (int again = 1; !used_ids_.insert(hashed_id(key)).second; ++again) {
    key.resize(4);
    key.push_back(std::to_string(again));
  }
  return hashed_id(key);
}

int IfcDocument::add_placement(int parent) { return step_.add("IFCLOCALPLACEMENT", {ref(parent), ref(world_)}); }

int IfcDocument::add_placement(const Eigen::Vector2d& origin, const Eigen::Vector2d& x_axis) {
  const auto triple = [](const Eigen::Vector2d& v) {
    return step::list({step_real(v.x()), step_real(v.y()), step_real(0.0)});
  };
  const int corner = step_.add("IFCCARTESIANPOINT", {triple(origin)});
  const int up = step_.add("IFCDIRECTION", {"(0.,0.,1.)"});
  const int along = step_.add("IFCDIRECTION", {triple(x_axis)});
  const int axes = step_.add("IFCAXIS2PLACEMENT3D", {ref(corner), ref(up), ref(along)});
  return step_.add("IFCLOCALPLACEMENT", {ref(building_placement_), ref(axes)});
}

int IfcDocument::add_product(std::string_view type, const ProductText& text, int shape,
                             const std::vector<std::string>& rest) {
  const int placement = text.placement != 0 ? text.placement : add_placement(building_placement_);
  const std::string id = new_id(text);
  std::vector<std::string> attributes{step_string(id),
                                      ref(owner_),
                                      step_string(text.name),
                                      none,
                                      text.object_type.empty() ? none : step_string(text.object_type),
                                      ref(placement),
                                      shape == 0 ? none : ref(shape)};
  attributes.insert(attributes.end(), rest.begin(), rest.end());
  const int number = step_.add(type, attributes);
  ids_[number] = id;
  return number;
}

int IfcDocument::relate(std::string_view type, const std::vector<std::string>& rest) {
  const std::string id = new_id({std::string(type), std::to_string(++relations_), "", -1});
  std::vector<std::string> attributes{step_string(id), ref(owner_), none, none};
  attributes.insert(attributes.end(), rest.begin(), rest.end());
  return step_.add(type, attributes);
}

void IfcDocument::add_properties(int product, std::string_view set, const std::vector<StepProperty>& properties) {
  std::vector<int> values;
  for (const StepProperty& property : properties)
    values.push_back(step_.add("IFCPROPERTYSINGLEVALUE", {step_string(property.name), none, property.value, none}));
  const std::string id = new_id({std::string(set), global_id_of(product) + "/" + std::string(set), "", -1});
  const int number =
      step_.add("IFCPROPERTYSET", {step_string(id), ref(owner_), step_string(set), none, step::refs(values)});
  relate("IFCRELDEFINESBYPROPERTIES", {step::refs({product}), ref(number)});
}

void IfcDocument::contain(int product, int storey) {
  contained_[storey < 0 ? building_ : storeys_.at(static_cast<std::size_t>(storey))].push_back(product);
}

void IfcDocument::decompose(int space, int storey) {
  decomposed_[storey < 0 ? building_ : storeys_.at(static_cast<std::size_t>(storey))].push_back(space);
}

std::optional<int> IfcDocument::material(const std::string& name) const {
  const auto found = materials_.find(name);
  return found == materials_.end() || name.empty() ? std::nullopt : std::optional(found->second);
}

void IfcDocument::assign_material(int product, const std::string& material) {
  if (!material.empty()) made_of_[material].push_back(product);
}

std::string IfcDocument::finish(bool sign) {
  for (const auto& [container, products] : contained_)
    relate("IFCRELCONTAINEDINSPATIALSTRUCTURE", {step::refs(products), ref(container)});
  for (const auto& [container, spaces] : decomposed_) relate("IFCRELAGGREGATES", {ref(container), step::refs(spaces)});
  for (const auto& [name, products] : made_of_)
    relate("IFCRELASSOCIATESMATERIAL", {step::refs(products), ref(materials_.at(name))});
  const std::string& data = step_.lines();
  return header(building_name_, sign ? roundtrip_signature(data) : std::string()) + "DATA;\n" + data +
         "ENDSEC;\nEND-ISO-10303-21;\n";
}

}  // namespace plumbline::bim
