// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "bim/formats/ifc/write/step_writer.h"
#include "bim/model/building.h"

namespace plumbline::bim {

/// A value of a property set: name and typed STEP value.
struct StepProperty {
  std::string name;
  std::string value;
};
[[nodiscard]] StepProperty length_property(const std::string& name, double value_m);
[[nodiscard]] StepProperty real_property(const std::string& name, double value);
[[nodiscard]] StepProperty text_property(const std::string& name, std::string_view text);
[[nodiscard]] StepProperty flag_property(const std::string& name, bool value);

/// What all products have.
struct ProductText {
  std::string kind;  ///< goes into the GlobalId, such as "wall"
  std::string id;
  std::string name;
  int storey = -1;
  std::string object_type = {};
  int placement = 0;  ///< number of an IfcLocalPlacement, 0 for the identity
};

/// An IFC file that grows product by product, begun with storeys and materials. Placements are the identity: all
/// coordinates are in W.
class IfcDocument {
 public:
  explicit IfcDocument(const Building& building);

  StepWriter& step() { return step_; }
  [[nodiscard]] int body_context() const { return body_context_; }
  [[nodiscard]] int axis_context() const { return axis_context_; }
  [[nodiscard]] int footprint_context() const { return footprint_context_; }

  /// A product with GlobalId, owner, name, type, placement and shape (0: none), then `rest` of its attributes.
  int add_product(std::string_view type, const ProductText& text, int shape, const std::vector<std::string>& rest);
  /// A placement in W with z up.
  int add_placement(const Eigen::Vector2d& origin, const Eigen::Vector2d& x_axis);
  /// A relation: GlobalId, owner and two empty attributes, then `rest`.
  int relate(std::string_view type, const std::vector<std::string>& rest);
  void add_properties(int product, std::string_view set, const std::vector<StepProperty>& properties);
  /// Files the product under its storey, under the building where it has none.
  void contain(int product, int storey);
  /// Files the space under its storey as a part of it.
  void decompose(int space, int storey);
  /// Empty names have no material.
  void assign_material(int product, const std::string& material);
  /// Colours an item as mesh files colour elements (bim/mesh/palette.h). Empty names leave it as it is.
  void assign_colour(int item, std::string_view colour);
  /// Number of an IfcMaterial, nothing for the empty name.
  [[nodiscard]] std::optional<int> material(const std::string& name) const;
  [[nodiscard]] const std::string& global_id_of(int product) const { return ids_.at(product); }

  [[nodiscard]] const std::string& storey_global_id(int storey) const {
    return ids_.at(storeys_.at(static_cast<std::size_t>(storey)));
  }

  /// Writes the collected relations and returns the whole file.
  [[nodiscard]] std::string finish(bool sign);

 private:
  void add_owner();
  void add_contexts(const Building& building);
  /// Where the origin lies on the map that the building was moved from.
  void add_map_conversion(const Eigen::Vector3d& moved_by);
  /// Number of the IfcUnitAssignment.
  int add_units();
  void add_head(const Building& building);
  void add_storeys(const std::vector<Storey>& storeys);
  /// IfcMaterials: those with optics first, in their order, then all further names.
  void add_materials(const Building& building);
  [[nodiscard]] std::string new_id(const ProductText& text);
  [[nodiscard]] int add_placement(int parent);
  void add_material(const Material* optics, const std::string& name);

  StepWriter step_;
  std::string building_name_;
  std::vector<std::string> storey_ids_;
  std::set<std::string> used_ids_;
  std::map<int, std::string> ids_;                          ///< GlobalId by number of the product
  std::vector<int> storeys_;                                ///< numbers of the IfcBuildingStoreys
  std::map<int, std::vector<int>> contained_, decomposed_;  ///< by number of the container
  std::map<std::string, int> materials_;
  std::map<std::string, int, std::less<>> styles_;   ///< IfcSurfaceStyles by name of the colour
  std::map<std::string, std::vector<int>> made_of_;  ///< products by material
  int owner_ = 0, context_ = 0, body_context_ = 0, axis_context_ = 0, footprint_context_ = 0;
  int world_ = 0, building_placement_ = 0, building_ = 0, relations_ = 0;
};

}  // namespace plumbline::bim
