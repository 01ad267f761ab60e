// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <set>
#include <vector>

#include "bim/formats/ifc/read/ifc.h"
#include "bim/formats/ifc/step/step_model.h"
#include "bim/model/boxes.h"
#include "bim/model/door_edges.h"

namespace plumbline::bim {

/// Turns the products of a file into parts of a building, kind by kind. Storeys come first, then walls, then openings,
/// since these are in walls or cut what comes after.
class Interpreter {
 public:
  Interpreter(const StepModel& model, const IfcConfig& config);

  /// Those of the file; without any, levels at which its walls, or else its other elements, begin.
  void add_storeys();
  /// Those of the file; without any, elements of no class of their own that stand like walls.
  void add_walls();
  /// Openings of walls; those of all else are remembered as cuts.
  void add_openings();
  /// Doors and windows that fill no opening of a wall: matched to one by where they stand, made one, or kept as
  /// obstacles.
  void add_unlinked_fillings();
  /// Where a door of one wall stands in another too, the other gives way.
  void open_overlapping_walls();
  void add_rooms();
  /// Those of the file; without any, elements of no class of their own that lie like floors.
  void add_slabs();
  /// Where rooms, or without any walls with doors, stand on floors of one storey far above each other, the upper ones
  /// become storeys. What is added later goes to these by its height.
  void split_storeys();
  void add_columns();
  void add_stairs();
  void add_obstacles();
  /// Storey heights and kinds from what stands on them; rooms from walls in a file without spaces; materials; canonical
  /// order of all lists.
  [[nodiscard]] Building finish();
  /// Doors that stand in no wall.
  [[nodiscard]] const std::vector<FreeDoor>& free_doors() const { return free_doors_; }

 private:
  /// What an opening cuts out of a wall.
  struct Cut {
    const StepProduct* product = nullptr;
    const StepProduct* filling = nullptr;
    int wall = -1;
    std::vector<Solid> solids;
    std::string id;
    bool of_part = false;  ///< the file has it cut a part of the wall
  };
  [[nodiscard]] bool join_cut(const Cut& cut, std::vector<Cut>& cuts) const;

  [[nodiscard]] int storey_index(const StepProduct& product, double z0_m) const;
  [[nodiscard]] const StepProduct* find(std::int64_t step_id) const;
  /// True for the product itself and all it is a part of.
  [[nodiscard]] bool within(const StepProduct& product, StepClass kind) const;

  /// Items of its own body; without one, those of its parts, which then do not stand for themselves.
  [[nodiscard]] std::vector<Solid> uncut_solids(const StepProduct& product);
  /// The same as one mesh, cut by the openings of the product and of what it is a part of. Empty where there is
  /// nothing, with a warning unless the product only groups others.
  [[nodiscard]] Solid body_of(const StepProduct& product);
  /// The parts of a product as one mesh, uncut.
  [[nodiscard]] Solid layers_of(const StepProduct& product);
  [[nodiscard]] std::vector<Solid> solids_of(const StepProduct& product);

  void assume_storeys();
  [[nodiscard]] bool makes_storey(const StepProduct& product, bool lookalikes) const;
  void leave_out_empty_storeys();
  void move_storeys_to_their_floors();
  /// True for elements whose class does not say what they are for, with a body that is still free.
  [[nodiscard]] bool is_nameless(const StepProduct& product) const;
  /// True for an element without body all of whose parts are layers with one, such as an assembly.
  [[nodiscard]] bool is_of_layers(const StepProduct& product) const;
  void move_up(int storey, double floor_m);
  /// By height, with all that names one.
  void sort_storeys();
  void take_as_wall(const StepProduct& product);
  void take_as_slab(const StepProduct& product);
  void read_reference_line(const StepProduct& product, const Solid& body, Wall& wall);
  void read_faces(const StepProduct& product, const Solid& body, Wall& wall);
  /// Takes the body's longer extent for the reference line of a wall with a straight body that its axis contradicts.
  [[nodiscard]] bool take_line_of_body(const StepProduct& product, Wall& wall);
  /// Adds a wall with its body; one whose body is bent, as its straight pieces.
  void add_straightened(const StepProduct& product, Wall wall);
  [[nodiscard]] std::vector<int> host_walls(const StepProduct& opening, const std::vector<Solid>& solids) const;
  void add_opening(const Cut& cut);
  void fill(Opening& opening, const StepProduct& filling) const;
  [[nodiscard]] bool fill_empty_opening(const StepProduct& filling, const Solid& body);
  [[nodiscard]] bool open_wall_for(const StepProduct& filling, const Solid& body);
  [[nodiscard]] std::optional<Opening> opening_in(const Wall& wall, int index, const Opening& opening,
                                                  const Polygon2& doorway) const;
  [[nodiscard]] bool has_opening_at(int wall, const Opening& like) const;
  [[nodiscard]] Solid opened_at_doors(const StepProduct& product, Solid covering);
  void add_stair_bodies(const StepProduct& product, Stair& stair);
  void place_stair(const StepProduct& product, Stair& stair);
  void add_obstacle(const StepProduct& product, const std::string& kind, const std::string& material, Solid body);

  void name_storeys_apart();
  /// False where both belong to buildings and these are not the same.
  [[nodiscard]] bool same_building(int storey, int other) const;
  /// The building as if that of a storey were the only one of the file.
  [[nodiscard]] Building only_building_of(int storey) const;
  void set_heights();
  [[nodiscard]] std::optional<Room> room_of(const StepProduct& space);
  struct NamedPlace {
    Eigen::Vector2d inner;
    double z_m = 0.0;
    std::string name;  ///< may be empty
    Polygon2 outline;
    const StepProduct* space = nullptr;
  };
  void name_by_outlines(const std::vector<NamedPlace>& places, std::vector<Room>& rooms);
  void add_missing_rooms(const std::vector<NamedPlace>& places);
  [[nodiscard]] std::vector<NamedPlace> places_of_outlines() const;
  [[nodiscard]] std::optional<PolygonWithHoles2> free_piece(const NamedPlace& place, const BoxIndex& room_boxes,
                                                            const BoxIndex& wall_boxes) const;
  void add_rooms_of_outlines(std::vector<NamedPlace> places);
  void warn_of_outlines();
  void add_materials();
  void sort_all();
  void warn(const StepProduct& product, WarningKind kind, const std::string& text);
  [[nodiscard]] double snapped(double v) const;

  const StepModel& model_;
  IfcConfig config_;
  Building building_;
  std::map<std::int64_t, const StepProduct*> products_;              ///< by STEP number
  std::map<std::int64_t, std::vector<const StepProduct*>> parts_;    ///< by STEP number of the whole
  std::map<std::int64_t, int> storeys_;                              ///< index by STEP number
  std::map<std::int64_t, std::vector<int>> uppers_;                  ///< split off a storey, by its STEP number
  std::map<int, std::int64_t> buildings_;                            ///< STEP number of the IfcBuilding by storey
  std::map<std::int64_t, std::vector<int>> walls_;                   ///< indices by STEP number
  std::map<std::int64_t, std::vector<const StepProduct*>> cutters_;  ///< openings by STEP number of what they cut
  std::set<std::int64_t> cutters_used_;                              ///< STEP numbers of what was cut
  std::vector<FreeDoor> free_doors_;
  std::set<std::int64_t> placed_;  ///< STEP numbers of spaces without a body whose outlines are or name rooms
  std::set<std::int64_t> taken_;   ///< STEP numbers of parts that went into their whole
};

/// Lowest and highest corner of a solid that has vertices.
struct Extent {
  Eigen::Vector3d low, high;
};
[[nodiscard]] Extent extent(const Solid& solid);

/// The outline of a solid seen from above.
[[nodiscard]] std::vector<PolygonWithHoles2> footprint(const Solid& solid);

}  // namespace plumbline::bim
