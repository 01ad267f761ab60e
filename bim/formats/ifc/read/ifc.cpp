// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/read/ifc.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "bim/config/tree.h"
#include "bim/errors.h"
#include "bim/formats/ifc/read/double_elements.h"
#include "bim/formats/ifc/read/interpret.h"
#include "bim/formats/ifc/read/partial_storeys.h"
#include "bim/formats/ifc/roundtrip/roundtrip_reader.h"
#include "bim/formats/ifc/roundtrip/roundtrip_signature.h"
#include "bim/formats/ifc/step/step_parse.h"
#include "bim/formats/ifc/step/step_repair.h"
#include "bim/formats/ifc/step/step_text.h"
#include "bim/model/floors.h"
#include "bim/model/odd_size.h"
#include "bim/model/permanence.h"
#include "bim/model/rooms.h"
#include "bim/model/through.h"
#include "bim/model/virtual_edges.h"

namespace plumbline::bim {
namespace {

std::string unit_name(double unit_m) {
  const auto is = [&](double v) { return std::abs(unit_m - v) < 1e-9 * v; };
  if (is(1.0)) return "m";
  if (is(0.1)) return "dm";
  if (is(0.01)) return "cm";
  if (is(0.001)) return "mm";
  if (is(0.3048)) return "ft";
  if (is(0.0254)) return "in";
  return format_number(unit_m) + " m";
}

std::string moved_text(const Eigen::Vector3d& move) {
  const auto number = [](double v) { return format_number(v + 0.0); };
  return "the file's coordinates are those of a map; moved by (" + number(move.x()) + ", " + number(move.y()) + ", " +
         number(move.z()) + ") m";
}

/// A door that joins nothing that is known: no room on either side, or the same on both.
void warn_of_unresolved_doors(Building& building) {
  for (const Opening& opening : building.openings) {
    if (opening.kind != OpeningKind::door || (opening.rooms[0] != opening.rooms[1])) continue;
    const bool in_wall = opening.wall >= 0;
    if (in_wall && !goes_through(opening, building.walls[static_cast<std::size_t>(opening.wall)])) continue;
    const int room = opening.rooms[0];
    const std::string where =
        room < 0 ? "in no room" : "in the same room, " + building.rooms[static_cast<std::size_t>(room)].id;
    building.warnings.push_back({opening.filling_id.empty() ? opening.id : opening.filling_id, "door_unresolved",
                                 "both of its sides are " + where + "; where it leads is not known"});
  }
}

[[noreturn]] void fail_without_ground(const std::string& file, std::size_t others) {
  throw InputError({file, 0, 0},
                   "nothing in it says where one could stand: it has no IfcSlab, no IfcSpace and no "
                   "IfcWall, only " +
                       std::to_string(others) + (others == 1 ? " other element" : " other elements"));
}

[[noreturn]] void fail_as_too_large(const Building& building, int count, const std::string& file) {
  throw InputError({file, 0, 0}, std::to_string(count) + (count == 1 ? " element is" : " elements are") +
                                     " larger than 10 km or further out than 100000 km, and nothing else in it says "
                                     "where one could stand; the file says " +
                                     building.unit + ": is the unit right?");
}

/// Refuses a file in which nothing can stand and says what it lacks.
void check_substance(const Building& building, const StepModel& model, const std::string& file) {
  const bool solid = !building.walls.empty() || !building.slabs.empty() || !building.rooms.empty() ||
                     !building.columns.empty() || !building.obstacles.empty() || !building.stairs.empty();
  const bool ground = !building.slabs.empty() || !building.rooms.empty() || !building.walls.empty();
  if (!ground && model.out_of_reach > 0) fail_as_too_large(building, model.out_of_reach, file);
  if (!solid) {
    // What is said of an element tells more than what is said of a class.
    auto reason = std::find_if(building.warnings.begin(), building.warnings.end(), [](const Warning& warning) {
      return !warning.element.empty() && (warning.kind == "dangling" || warning.kind == "makes_no_sense" ||
                                          warning.kind == "skipped_placement" || warning.kind == "no_body");
    });
    if (reason == building.warnings.end())
      reason = std::find_if(building.warnings.begin(), building.warnings.end(), [](const Warning& warning) {
        return warning.kind == "dangling" || warning.kind == "unknown_class";
      });
    const auto fillings = std::count_if(model.products.begin(), model.products.end(), [](const StepProduct& product) {
      return product.has_body && (product.kind == StepClass::door || product.kind == StepClass::window);
    });
    if (reason == building.warnings.end() && fillings > 0)
      fail_without_ground(file, static_cast<std::size_t>(fillings));
    const std::string left_out =
        reason == building.warnings.end() ? std::string() : "; the first that was left out: " + reason->text;
    throw InputError({file, 0, 0},
                     "nothing in it has a body: no IfcWall, IfcSlab, IfcSpace or other element that can "
                     "be read" +
                         left_out);
  }
  if (!ground) fail_without_ground(file, building.obstacles.size() + building.columns.size());
}

/// What methods that localize see in a plan without walls is all that was built to stay.
void warn_of_missing_walls(const StepModel& model, Building& building) {
  if (!building.walls.empty()) return;
  const bool unread = std::any_of(model.products.begin(), model.products.end(),
                                  [](const StepProduct& product) { return product.kind == StepClass::wall; });
  const std::string none = unread ? "the file has no IfcWall that can be read" : "the file has no IfcWall";
  const auto others = std::count_if(building.obstacles.begin(), building.obstacles.end(),
                                    [](const Obstacle& obstacle) { return !may_have_moved(obstacle); }) +
                      static_cast<std::ptrdiff_t>(building.columns.size());
  building.warnings.push_back(
      {"", "no_walls",
       others > 0 ? none + "; methods that localize go by its other elements that stay where they are (" +
                        std::to_string(others) + "), and `walls.*` are not scored"
                  : none + ", nor any other element that stays where it is; methods that localize have "
                           "nothing to go by"});
}

void warn_of_missing_floors(Building& building) {
  constexpr double over_head_m = 1.8;
  std::map<int, std::pair<int, int>> lacking;  // storey to rooms without slab, and whether it has nothing at all
  std::map<int, double> lowest_m;              // of the pieces of a storey
  for (const FloorPiece& piece : floor_pieces(building)) {
    if (piece.storey >= 0) {
      double& lowest = lowest_m.try_emplace(piece.storey, std::numeric_limits<double>::infinity()).first->second;
      for (const Eigen::Vector2d& p : piece.polygon.outer) lowest = std::min(lowest, piece.z_at(p));
    }
    if (piece.source == FloorSource::room) ++lacking[piece.storey].first;
    if (piece.source == FloorSource::walls) ++lacking[piece.storey].second;
  }
  for (const auto& [index, lowest] : lowest_m) {
    const Storey& storey = building.storeys[static_cast<std::size_t>(index)];
    if (lacking.contains(index) || lowest <= storey.elevation_m + over_head_m) continue;
    building.warnings.push_back(
        {storey.id, "no_floor",
         "its slabs lie " + format_number(std::round(1e2 * (lowest - storey.elevation_m)) / 1e2) +
             " m and more above it and are no floor; what is under them, or near its walls, is taken as floor"});
  }
  for (const auto& [index, rooms] : lacking) {
    const Storey& storey = building.storeys[static_cast<std::size_t>(index)];
    building.warnings.push_back(
        {storey.id, "no_floor",
         rooms.second > 0 ? "the storey has neither slabs nor rooms; all within its walls is taken as floor"
         : rooms.first == 1
             ? "1 of its rooms has no slab; its lower end is the floor"
             : std::to_string(rooms.first) + " of its rooms have no slab; their lower ends are the floor"});
  }
}

/// What is said of the whole file: its size, where it lies, and the schema that it is read as.
void warn_of_the_file(const StepModel& model, const std::string& read_as, Building& building) {
  if (const std::string odd = odd_size(building); !odd.empty())
    building.warnings.push_back({"", "odd_size", odd + " The file says " + building.unit});
  if (model.move) building.warnings.push_back({"", "recentred", moved_text(*model.move)});
  if (read_as != building.schema)
    building.warnings.push_back({"", "other_schema", building.schema + " read as " + read_as});
}

void find_relations(const std::vector<FreeDoor>& free_doors, Building& building) {
  find_room_walls(building);
  find_opening_rooms(building);
  warn_of_unresolved_doors(building);
  find_virtual_edges(building);
  add_door_edges(building, free_doors);
  find_stair_rooms(building);
}

}  // namespace

Building read_ifc_text(std::string_view text, const std::string& file, const IfcConfig& config) {
  const std::string clean = without_comments(text);
  StepText checked = check_step_text(clean, file);
  if (has_roundtrip_signature(text)) return read_roundtrip(clean, file);
  const std::string said = checked.schema;
  checked.schema = schema_of_entities(clean, checked, file);
  StepModel model = read_step_model(clean, checked, file);
  leave_out_doubles(model);
  join_partial_storeys(model);

  Interpreter interpreter(model, config);
  interpreter.add_storeys();
  interpreter.add_walls();
  interpreter.add_openings();
  interpreter.add_unlinked_fillings();
  interpreter.open_overlapping_walls();
  interpreter.add_rooms();
  interpreter.add_slabs();
  interpreter.split_storeys();
  interpreter.add_columns();
  interpreter.add_stairs();
  interpreter.add_obstacles();
  Building building = interpreter.finish();

  building.name = model.name;
  building.schema = said;
  building.unit = unit_name(model.unit_m);
  check_substance(building, model, file);
  warn_of_missing_walls(model, building);
  building.moved_by = model.move;
  warn_of_the_file(model, schema_for_reader(checked.schema), building);
  find_relations(interpreter.free_doors(), building);
  warn_of_missing_floors(building);
  return building;
}

}  // namespace plumbline::bim
