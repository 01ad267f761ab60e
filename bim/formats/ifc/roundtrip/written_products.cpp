// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/roundtrip/written_products.h"

#include <cmath>

namespace plumbline::bim {
namespace {

constexpr double furthest_m = 1e7;  // as for any IFC file

}  // namespace

double length_of(const StepValue& value) {
  const double v = value.as_number();
  if (std::abs(v) > furthest_m) throw InputError(value.mark, "a length is further than 10000 km");
  return v;
}

const StepValue& WrittenProduct::property(const std::string& name) const {
  const auto found = properties.find(name);
  if (found == properties.end()) throw InputError(attributes.mark, set + " has no property " + name);
  return found->second.as_typed();
}

std::string WrittenProduct::text(const std::string& name) const { return property(name).as_text(); }
double WrittenProduct::real(const std::string& name) const { return length_of(property(name)); }
bool WrittenProduct::flag(const std::string& name) const { return property(name).as_flag(); }
std::string WrittenProduct::name() const { return attributes.at(2).as_text(); }

WrittenProducts::WrittenProducts(const StepEntities& entities) : entities_(entities) {
  for (const StepEntities::Entity& entity : entities.all()) relate(entity);
}

void WrittenProducts::relate(const StepEntities::Entity& entity) {
  if (!entity.type.starts_with("IFCREL")) return;
  const StepValue relation = entities_.attributes(entity);
  if (entity.type == "IFCRELDEFINESBYPROPERTIES") {
    read_properties(relation);
  } else if (entity.type == "IFCRELCONTAINEDINSPATIALSTRUCTURE") {
    for (const StepValue& product : relation.at(4).as_list())
      wholes_[product.as_reference()] = relation.at(5).as_reference();
  } else if (entity.type == "IFCRELAGGREGATES") {
    const std::int64_t whole = relation.at(4).as_reference();
    for (const StepValue& part : relation.at(5).as_list()) {
      wholes_[part.as_reference()] = whole;
      parts_[whole].push_back(part.as_reference());
    }
  } else if (entity.type == "IFCRELVOIDSELEMENT") {
    hosts_[relation.at(5).as_reference()] = relation.at(4).as_reference();
  } else if (entity.type == "IFCRELSPACEBOUNDARY") {
    bounds_[relation.at(4).as_reference()].push_back(relation.at(5).as_reference());
  } else if (entity.type == "IFCRELASSOCIATESMATERIAL") {
    for (const StepValue& product : relation.at(4).as_list()) materials_[product.as_reference()] = relation.at(5);
  }
}

void WrittenProducts::read_properties(const StepValue& relation) {
  const StepValue set = entities_.attributes(relation.at(5), "IFCPROPERTYSET");
  const std::string& name = set.at(2).as_text();
  if (!name.starts_with("Plumbline_")) return;
  WrittenProduct product;
  product.set = name;
  product.number = relation.at(4).at(0).as_reference();
  product.attributes = entities_.attributes(product.number);
  for (const StepValue& reference : set.at(4).as_list()) {
    const StepValue property = entities_.attributes(reference, "IFCPROPERTYSINGLEVALUE");
    product.properties[property.at(0).as_text()] = property.at(2);
  }
  products_[product.number] = std::move(product);
}

std::vector<WrittenProduct> WrittenProducts::with(std::string_view set) const {
  std::vector<WrittenProduct> result;
  for (const auto& [number, product] : products_)
    if (product.set == set) result.push_back(product);
  return result;
}

std::int64_t WrittenProducts::whole_of(std::int64_t product) const {
  const auto found = wholes_.find(product);
  return found == wholes_.end() ? 0 : found->second;
}

std::int64_t WrittenProducts::host_of(const WrittenProduct& opening) const {
  const auto found = hosts_.find(opening.number);
  if (found == hosts_.end()) throw InputError(opening.attributes.mark, "this opening is in no wall");
  return found->second;
}

const std::vector<std::int64_t>& WrittenProducts::parts_of(std::int64_t product) const {
  const auto found = parts_.find(product);
  return found == parts_.end() ? none_ : found->second;
}

const std::vector<std::int64_t>& WrittenProducts::bounds_of(std::int64_t space) const {
  const auto found = bounds_.find(space);
  return found == bounds_.end() ? none_ : found->second;
}

StepValue WrittenProducts::layer_of(const WrittenProduct& wall) const {
  const auto found = materials_.find(wall.number);
  if (found == materials_.end()) throw InputError(wall.attributes.mark, "this wall has no layers");
  StepValue set = found->second;
  if (entities_.entity(set.as_reference()).type == "IFCMATERIALLAYERSETUSAGE")
    set = entities_.attributes(set, "IFCMATERIALLAYERSETUSAGE").at(0);
  const StepValue layers = entities_.attributes(set, "IFCMATERIALLAYERSET");
  return entities_.attributes(layers.at(0).at(0), "IFCMATERIALLAYER");
}

std::string WrittenProducts::material_of(std::int64_t product) const {
  const auto found = materials_.find(product);
  if (found == materials_.end()) return {};
  return entities_.attributes(found->second, "IFCMATERIAL").at(0).as_text();
}

std::vector<StepValue> WrittenProducts::items(const WrittenProduct& product, std::string_view representation) const {
  const StepValue& shape = product.attributes.at(6);
  if (shape.kind == StepValue::Kind::none) return {};
  for (const StepValue& reference : entities_.attributes(shape, "IFCPRODUCTDEFINITIONSHAPE").at(2).as_list()) {
    const StepValue candidate = entities_.attributes(reference, "IFCSHAPEREPRESENTATION");
    if (candidate.at(1).as_text() == representation) return candidate.at(3).as_list();
  }
  return {};
}

Solid WrittenProducts::solid(const StepValue& face_set) const {
  const StepValue faces = entities_.attributes(face_set, "IFCTRIANGULATEDFACESET");
  Solid solid;
  for (const StepValue& p : entities_.attributes(faces.at(0), "IFCCARTESIANPOINTLIST3D").at(0).as_list())
    solid.vertices.emplace_back(length_of(p.at(0)), length_of(p.at(1)), length_of(p.at(2)));
  const int count = static_cast<int>(solid.vertices.size());
  for (const StepValue& corners : faces.at(3).as_list()) {
    const Eigen::Vector3i t(corners.at(0).as_integer(), corners.at(1).as_integer(), corners.at(2).as_integer());
    if (t.minCoeff() < 1 || t.maxCoeff() > count)
      throw InputError(corners.mark, "a triangle names a vertex beyond the " + std::to_string(count) + " there are");
    solid.triangles.push_back(t.array() - 1);
  }
  return solid;
}

std::vector<Solid> WrittenProducts::solids(const WrittenProduct& product) const {
  std::vector<Solid> result;
  for (const StepValue& item : items(product, "Body")) result.push_back(solid(item));
  return result;
}

std::vector<Polygon2> WrittenProducts::curves(const WrittenProduct& product, std::string_view representation) const {
  std::vector<Polygon2> result;
  for (const StepValue& item : items(product, representation)) {
    Polygon2& curve = result.emplace_back();
    for (const StepValue& point : entities_.attributes(item, "IFCPOLYLINE").at(0).as_list()) {
      const StepValue p = entities_.attributes(point, "IFCCARTESIANPOINT").at(0);
      curve.emplace_back(length_of(p.at(0)), length_of(p.at(1)));
    }
    if (curve.size() < 2) throw InputError(item.mark, "a line with less than two points");
  }
  return result;
}

PolygonWithHoles2 WrittenProducts::footprint(const WrittenProduct& product) const {
  PolygonWithHoles2 outline;
  for (Polygon2& ring : curves(product, "FootPrint")) {
    ring.pop_back();  // the first point again
    if (outline.outer.empty()) {
      outline.outer = std::move(ring);
    } else {
      outline.holes.push_back(std::move(ring));
    }
  }
  return outline;
}

}  // namespace plumbline::bim
