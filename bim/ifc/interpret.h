// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include "bim/ifc/ifc.h"
#include "bim/ifc/step_model.h"

namespace plumbline::bim {

/// Turns the products of a file into parts of a building, kind by kind. Storeys come first, walls before openings.
class Interpreter {
 public:
  Interpreter(const StepModel& model, const IfcConfig& config) : model_(model), config_(config) {}

  void add_storeys();
  void add_walls();
  /// Openings of walls; those of slabs are remembered for add_slabs().
  void add_openings();
  void add_rooms();
  void add_slabs();
  void add_columns();
  void add_obstacles();
  /// Storey heights from what stands on them; rooms from walls in a file without spaces; canonical order of all lists.
  [[nodiscard]] Building finish();

 private:
  [[nodiscard]] int storey_index(const StepProduct& product, double z0_m) const;
  [[nodiscard]] std::vector<Solid> solids_of(const StepProduct& product);
  /// The items of the body as one mesh; empty and warned of when there is none.
  [[nodiscard]] Solid body_of(const StepProduct& product);
  void read_reference_line(const StepProduct& product, const Solid& body, Wall& wall);
  void read_faces(const StepProduct& product, const Solid& body, Wall& wall);
  void set_heights();
  void add_missing_rooms();
  void sort_all();
  void warn(const StepProduct& product, const std::string& kind, const std::string& text);
  [[nodiscard]] double snapped(double v) const;

  const StepModel& model_;
  IfcConfig config_;
  Building building_;
  std::map<std::int64_t, int> storeys_;                       ///< index by STEP number
  std::map<std::int64_t, int> walls_;                         ///< index by STEP number
  std::map<std::int64_t, std::vector<Solid>> slab_openings_;  ///< by STEP number of the slab
};

/// Lowest and highest corner of a solid that has vertices.
struct Extent {
  Eigen::Vector3d low, high;
};
[[nodiscard]] Extent extent(const Solid& solid);

/// The outline of a solid seen from above.
[[nodiscard]] std::vector<PolygonWithHoles2> footprint(const Solid& solid);

}  // namespace plumbline::bim
