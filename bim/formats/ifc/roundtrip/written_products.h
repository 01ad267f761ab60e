// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "bim/formats/ifc/step/step_entities.h"
#include "bim/model/building.h"

namespace plumbline::bim {

/// A number of metres. Throws InputError where it is further than any map grid.
[[nodiscard]] double length_of(const StepValue& value);

/// A product of a file that write_ifc() wrote, with its own property set.
struct WrittenProduct {
  std::int64_t number = 0;
  std::string set;  ///< such as "Plumbline_Wall"
  std::map<std::string, StepValue> properties;
  StepValue attributes;

  [[nodiscard]] std::string text(const std::string& name) const;
  [[nodiscard]] double real(const std::string& name) const;
  [[nodiscard]] bool flag(const std::string& name) const;
  /// The attribute Name.
  [[nodiscard]] std::string name() const;
  [[nodiscard]] std::string global_id() const { return attributes.at(0).as_text(); }

 private:
  [[nodiscard]] const StepValue& property(const std::string& name) const;
};

/// Products, relations and shapes of such a file, looked up by entity number.
class WrittenProducts {
 public:
  explicit WrittenProducts(const StepEntities& entities);

  /// Products with the property set, in the order of the file.
  [[nodiscard]] std::vector<WrittenProduct> with(std::string_view set) const;
  /// What contains or decomposes into the product, 0 for nothing.
  [[nodiscard]] std::int64_t whole_of(std::int64_t product) const;
  /// The wall an opening voids. Throws InputError where there is none.
  [[nodiscard]] std::int64_t host_of(const WrittenProduct& opening) const;
  /// Parts in the order of the file.
  [[nodiscard]] const std::vector<std::int64_t>& parts_of(std::int64_t product) const;
  /// Elements that bound a space, in the order of the file.
  [[nodiscard]] const std::vector<std::int64_t>& bounds_of(std::int64_t space) const;
  /// Name of the material, empty without one.
  [[nodiscard]] std::string material_of(std::int64_t product) const;
  /// Attributes of the one IfcMaterialLayer of a wall.
  [[nodiscard]] StepValue layer_of(const WrittenProduct& wall) const;

  [[nodiscard]] std::vector<Solid> solids(const WrittenProduct& product) const;
  /// Polylines of a representation, as they stand.
  [[nodiscard]] std::vector<Polygon2> curves(const WrittenProduct& product, std::string_view representation) const;
  /// Rings of the footprint, outer first; an empty outline where there is none.
  [[nodiscard]] PolygonWithHoles2 footprint(const WrittenProduct& product) const;

 private:
  void read_properties(const StepValue& relation);
  void relate(const StepEntities::Entity& entity);
  [[nodiscard]] std::vector<StepValue> items(const WrittenProduct& product, std::string_view representation) const;
  [[nodiscard]] Solid solid(const StepValue& face_set) const;

  const StepEntities& entities_;
  std::map<std::int64_t, WrittenProduct> products_;
  std::map<std::int64_t, std::int64_t> wholes_, hosts_;
  std::map<std::int64_t, std::vector<std::int64_t>> parts_, bounds_;
  std::map<std::int64_t, StepValue> materials_;  ///< reference to a material or layer set usage by product
  std::vector<std::int64_t> none_;
};

}  // namespace plumbline::bim
