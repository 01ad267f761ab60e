// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/roundtrip/roundtrip_reader.h"

#include <algorithm>
#include <map>
#include <optional>

#include "bim/formats/ifc/roundtrip/roundtrip_signature.h"
#include "bim/formats/ifc/roundtrip/wall_placement.h"
#include "bim/formats/ifc/roundtrip/written_products.h"

namespace plumbline::bim {
namespace {

constexpr double shortest_wall_m = 1e-6;
constexpr int most_steps = 10000;

/// Takes the parts of a building from its products, kind by kind.
class WrittenReader {
 public:
  WrittenReader(std::string_view text, const std::string& file) : entities_(text, file), products_(entities_) {}

  Building read() {
    building_.schema = "IFC4";
    building_.unit = "m";
    read_head();
    read_storeys();
    read_rooms();
    read_walls();
    read_boundaries();
    read_openings();
    read_slabs();
    read_columns();
    read_stairs();
    read_obstacles();
    return std::move(building_);
  }

 private:
  [[noreturn]] static void fail(const WrittenProduct& product, const std::string& what) {
    throw InputError(product.attributes.mark, what);
  }

  void read_head() {
    for (const StepEntities::Entity& entity : entities_.all()) {
      if (entity.type == "IFCBUILDING") building_.name = entities_.attributes(entity).at(2).as_text();
      if (entity.type == "IFCMAPCONVERSION") {
        const StepValue map = entities_.attributes(entity);
        building_.moved_by = -Eigen::Vector3d(map.at(2).as_number(), map.at(3).as_number(), map.at(4).as_number());
      }
      if (entity.type != "IFCMATERIALPROPERTIES") continue;
      const StepValue properties = entities_.attributes(entity);
      const auto value = [&](std::size_t at) {
        return entities_.attributes(properties.at(2).at(at), "IFCPROPERTYSINGLEVALUE").at(2).as_typed().as_number();
      };
      const StepValue material = entities_.attributes(properties.at(3), "IFCMATERIAL");
      building_.materials.push_back({material.at(0).as_text(), value(0), value(1), value(2)});
    }
  }

  void read_storeys() {
    for (const WrittenProduct& product : products_.with("Plumbline_Storey")) {
      Storey storey;
      storey.id = product.text("Id");
      storey.name = product.name();
      storey.elevation_m = length_of(product.attributes.at(9));
      storey.height_m = product.real("Height");
      const std::optional<StoreyKind> kind = storey_kind_of(product.text("Kind"));
      if (!kind) fail(product, "a storey is habitable, foundation or roof");
      storey.kind = *kind;
      storey.step_id = product.number;
      storeys_[product.number] = static_cast<int>(building_.storeys.size());
      storey_ids_[product.global_id()] = static_cast<int>(building_.storeys.size());
      building_.storeys.push_back(std::move(storey));
    }
  }

  [[nodiscard]] int storey_of(const WrittenProduct& product) const {
    const auto found = storeys_.find(products_.whole_of(product.number));
    return found == storeys_.end() ? -1 : found->second;
  }

  /// Index of what a property names by its GlobalId, -1 where it names nothing.
  static int named(const WrittenProduct& product, const std::string& property, const std::map<std::string, int>& ids) {
    const std::string id = product.text(property);
    if (id.empty()) return -1;
    const auto found = ids.find(id);
    if (found == ids.end()) fail(product, property + " names " + id + ", which is not in the file");
    return found->second;
  }

  void read_rooms() {
    for (const WrittenProduct& product : products_.with("Plumbline_Space")) {
      Room room;
      room.id = product.text("Id");
      room.name = product.name();
      room.storey = storey_of(product);
      const PolygonWithHoles2 outline = products_.footprint(product);
      room.polygon = outline.outer;
      room.holes = outline.holes;
      room.z0_m = product.real("Floor");
      room.z1_m = product.real("Ceiling");
      room.step_id = product.number;
      room_ids_[product.global_id()] = static_cast<int>(building_.rooms.size());
      building_.rooms.push_back(std::move(room));
    }
  }

  void read_walls() {
    for (const WrittenProduct& product : products_.with("Plumbline_Wall")) {
      Wall wall;
      wall.id = product.text("Id");
      wall.name = product.name();
      wall.storey = storey_of(product);
      wall.a = {product.real("StartX"), product.real("StartY")};
      wall.b = {product.real("EndX"), product.real("EndY")};
      if (wall.length() < shortest_wall_m) fail(product, "a wall begins where it ends");
      const StepValue layer = products_.layer_of(product);
      wall.offset_m = product.real("Offset");
      wall.thickness_m = length_of(layer.at(1));
      if (layer.at(0).kind == StepValue::Kind::reference)
        wall.material = entities_.attributes(layer.at(0), "IFCMATERIAL").at(0).as_text();
      wall.z0_m = product.real("Bottom");
      wall.z1_m = product.real("Top");
      wall.slope = product.real("Slope");
      wall.body = own_body(product);
      if (wall.body && product.flag("Placed")) wall.body = out_of_placement(wall, *std::move(wall.body));
      wall.step_id = product.number;
      walls_[product.number] = static_cast<int>(building_.walls.size());
      building_.walls.push_back(std::move(wall));
    }
  }

  /// The body where it is more than what the other values say.
  [[nodiscard]] std::optional<Solid> own_body(const WrittenProduct& product) const {
    if (!product.flag("OwnBody")) return std::nullopt;
    std::vector<Solid> solids = products_.solids(product);
    return solids.empty() ? Solid{} : std::move(solids.front());
  }

  void read_boundaries() {
    std::map<std::int64_t, WrittenProduct> edges;
    for (WrittenProduct& edge : products_.with("Plumbline_VirtualEdge")) edges[edge.number] = std::move(edge);
    for (Room& room : building_.rooms) {
      for (const std::int64_t element : products_.bounds_of(room.step_id)) {
        if (const auto wall = walls_.find(element); wall != walls_.end()) {
          room.walls.push_back(wall->second);
        } else if (const auto edge = edges.find(element); edge != edges.end()) {
          const std::vector<Polygon2> line = products_.curves(edge->second, "Axis");
          if (line.size() != 1) fail(edge->second, "an open edge has a line");
          const bool door = edge->second.properties.contains("Door");
          room.virtual_edges.push_back({line[0].front(), line[0].back(), named(edge->second, "Beyond", room_ids_),
                                        door ? edge->second.text("Door") : ""});
        }
      }
    }
  }

  void read_openings() {
    for (const WrittenProduct& product : products_.with("Plumbline_Opening")) {
      Opening opening;
      opening.id = product.text("Id");
      const auto wall = walls_.find(products_.host_of(product));
      if (wall == walls_.end()) fail(product, "this opening is in no wall");
      opening.wall = wall->second;
      const std::optional<OpeningKind> kind = opening_kind_of(product.text("Kind"));
      const std::optional<Leaf> leaf = leaf_of(product.text("Leaf"));
      if (!kind || !leaf) fail(product, "an opening is a door, window or void, its leaf open, closed or none");
      opening.kind = *kind;
      opening.leaf = *leaf;
      opening.s_m = product.real("Along");
      opening.width_m = product.real("Width");
      opening.z0_m = product.real("Bottom");
      opening.z1_m = product.real("Top");
      opening.material = product.text("Material");
      opening.filling_id = product.text("Filling");
      opening.rooms[0] = named(product, "RoomLeft", room_ids_);
      opening.rooms[1] = named(product, "RoomRight", room_ids_);
      if (product.flag("OwnBody")) {
        std::vector<Solid> solids = products_.solids(product);
        opening.solid = solids.empty() ? Solid{} : solids.front();
        if (solids.size() > 1) opening.parts.assign(solids.begin() + 1, solids.end());
      }
      opening.step_id = product.number;
      building_.openings.push_back(std::move(opening));
    }
  }

  void read_slabs() {
    for (const WrittenProduct& product : products_.with("Plumbline_Slab")) {
      building_.slabs.push_back({product.text("Id"), storey_of(product), products_.footprint(product),
                                 product.real("Bottom"), product.real("Top"), products_.material_of(product.number),
                                 own_body(product), product.number});
    }
  }

  void read_columns() {
    for (const WrittenProduct& product : products_.with("Plumbline_Column")) {
      building_.columns.push_back({product.text("Id"), storey_of(product), products_.footprint(product).outer,
                                   product.real("Bottom"), product.real("Top"), products_.material_of(product.number),
                                   own_body(product), product.number});
    }
  }

  void read_stairs() {
    std::map<std::int64_t, WrittenProduct> parts;
    for (const char* set : {"Plumbline_StairFlight", "Plumbline_Landing"})
      for (WrittenProduct& part : products_.with(set)) parts[part.number] = std::move(part);
    for (const WrittenProduct& product : products_.with("Plumbline_Stair")) {
      Stair stair;
      stair.id = product.text("Id");
      stair.name = product.name();
      stair.from = named(product, "From", storey_ids_);
      stair.to = named(product, "To", storey_ids_);
      stair.rooms[0] = named(product, "RoomFoot", room_ids_);
      stair.rooms[1] = named(product, "RoomHead", room_ids_);
      stair.material = products_.material_of(product.number);
      stair.step_id = product.number;
      stair.bodies = products_.solids(product);
      for (const std::int64_t number : products_.parts_of(product.number)) {
        const auto part = parts.find(number);
        if (part == parts.end()) fail(product, "a stair is made of flights and landings");
        add_part(part->second, stair);
      }
      building_.stairs.push_back(std::move(stair));
    }
  }

  void add_part(const WrittenProduct& part, Stair& stair) const {
    for (Solid& body : products_.solids(part)) stair.bodies.push_back(std::move(body));
    if (part.set == "Plumbline_Landing") {
      stair.landings.push_back({products_.footprint(part).outer, part.real("Level")});
      return;
    }
    const std::vector<Polygon2> axis = products_.curves(part, "Axis");
    if (axis.size() != 1) fail(part, "a flight has a walking line");
    const int steps = part.attributes.at(8).as_integer();
    if (steps < 0 || steps > most_steps) fail(part, "a flight has 0 to " + std::to_string(most_steps) + " steps");
    stair.flights.push_back({axis[0].front(), part.real("Yaw"), part.real("Width"), part.real("Bottom"), steps,
                             length_of(part.attributes.at(10)), length_of(part.attributes.at(11))});
  }

  void read_obstacles() {
    for (const WrittenProduct& product : products_.with("Plumbline_Obstacle")) {
      std::vector<Solid> solids = products_.solids(product);
      building_.obstacles.push_back({product.text("Id"), product.text("Kind"), named(product, "Storey", storey_ids_),
                                     solids.empty() ? Solid{} : std::move(solids.front()), product.flag("Planned"),
                                     product.number, products_.material_of(product.number)});
    }
  }

  StepEntities entities_;
  WrittenProducts products_;
  Building building_;
  std::map<std::int64_t, int> storeys_, walls_;       ///< index by entity number
  std::map<std::string, int> storey_ids_, room_ids_;  ///< index by GlobalId
};

}  // namespace

Building read_roundtrip(std::string_view text, const std::string& file) { return WrittenReader(text, file).read(); }

}  // namespace plumbline::bim
