// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bim/formats/ifc/write/write_document.h"
#include "bim/formats/ifc/write/write_ifc.h"
#include "bim/formats/ifc/write/write_shapes.h"
#include "bim/model/building.h"

namespace plumbline::bim {

/// Writes the elements of a building kind by kind. Rooms come before what names them, walls before what bounds rooms
/// or stands in walls. Entities of a kind stand in the order of the building's list.
class ElementWriter {
 public:
  ElementWriter(const Building& building, const IfcWriteConfig& config, IfcDocument& document)
      : building_(building), config_(config), document_(document) {}

  void add_rooms();
  void add_walls();
  /// Spaces to the walls that bound them and to virtual elements where nothing does.
  void add_boundaries();
  void add_openings();
  void add_slabs();
  void add_columns();
  void add_stairs();
  /// Leaves and panes become the door or window of their opening.
  void add_obstacles();
  /// Doors and windows that no obstacle stands for.
  void add_fillings();

 private:
  void add_layers(const Wall& wall, int product, bool placed);
  void add_wall_properties(const Wall& wall, int product, bool placed);
  [[nodiscard]] static Prism box_in_placement(const Wall& wall);
  [[nodiscard]] Prism opening_prism(const Opening& opening) const;
  [[nodiscard]] Prism leaf_prism(const Opening& opening) const;
  /// Outline in a wall's plan, across it from `low` to `high` of its reference line, upright as the wall is.
  [[nodiscard]] Prism across(const Opening& opening, double low_m, double high_m) const;
  int add_filling(const Opening& opening, int number, int shape);
  [[nodiscard]] int opening_of(const Obstacle& obstacle) const;
  void add_virtual_edge(const Room& room, int space, const VirtualEdge& edge, int count);
  int add_flight(const Stair& stair, const StairFlight& flight, int count, const std::vector<Solid>& bodies);
  int add_landing(const Stair& stair, const Landing& landing, int count, const std::vector<Solid>& bodies);
  [[nodiscard]] StepProperty room_property(const std::string& name, int room) const;
  [[nodiscard]] StepProperty storey_property(const std::string& name, int storey) const;

  const Building& building_;
  IfcWriteConfig config_;
  IfcDocument& document_;
  std::vector<int> rooms_, walls_, openings_;  ///< entity numbers in the order of the lists
  std::vector<bool> filled_;                   ///< openings whose door or window is written
};

}  // namespace plumbline::bim
