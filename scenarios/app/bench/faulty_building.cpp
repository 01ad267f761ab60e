// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/bench/faulty_building.h"

#include <algorithm>
#include <cmath>

#include "bim/errors.h"
#include "bim/formats/plan_yaml/plan_write.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/generators/generators.h"
#include "bim/random/stream.h"
#include "scenarios/spec/walk_coverage.h"

namespace plumbline::scenarios {

namespace {

/// Shares of the doors and rooms that are spoilt.
struct FaultShares {
  double closed = 0.10, narrow = 0.10, overlapping = 0.08, floor = 0.05;
};

constexpr double open_edge_m = 0.8;  ///< between two rooms, to walk through

/// Draws from the numbers of the generators; each building has a seed of its own.
class Spoiler {
 public:
  Spoiler(FaultyBuilding& out, std::uint64_t k) : out_(out), stream_(k, "bim.generate") {}

  void spoil() {
    const FaultShares shares;
    const std::size_t doors = out_.building.openings.size();
    for (std::size_t i = 0; i < doors; ++i) {
      if (out_.building.openings[i].kind != bim::OpeningKind::door) continue;
      const double u = stream_.uniform(i, door_lane);
      if (u < shares.closed)
        close(i);
      else if (u < shares.closed + shares.narrow)
        narrow(i);
      else if (u < shares.closed + shares.narrow + shares.overlapping)
        overlap(i);
    }
    for (std::size_t i = 0; i < out_.building.rooms.size(); ++i)
      if (stream_.uniform(i, room_lane) < shares.floor) remove_floor(i);
  }

 private:
  static constexpr std::uint32_t door_lane = 100;  ///< beyond those of the generators
  static constexpr std::uint32_t room_lane = 101;

  void close(std::size_t i) {
    bim::Opening& door = out_.building.openings[i];
    door.leaf = bim::Leaf::closed;
    out_.faults.push_back({FaultKind::closed_door, "door '" + door.id + "'", door.id});
  }

  void narrow(std::size_t i) {
    bim::Opening& door = out_.building.openings[i];
    door.width_m = 0.4 + 0.2 * stream_.uniform(i, door_lane, 1);
    out_.faults.push_back({FaultKind::narrow_door, "door '" + door.id + "'", door.id});
  }

  void overlap(std::size_t i) {
    const bim::Opening& door = out_.building.openings[i];
    bim::Wall wall = out_.building.walls[static_cast<std::size_t>(door.wall)];
    const double half = 0.5 * door.width_m + 0.15;
    const Eigen::Vector2d a = wall.a, e = wall.direction();
    wall.id += "/over/" + door.id;
    wall.a = a + (door.s_m - half) * e;
    wall.b = a + (door.s_m + half) * e;
    wall.body.reset();
    out_.faults.push_back({FaultKind::overlapping_wall, "wall '" + wall.id + "'", door.id});
    out_.building.walls.push_back(std::move(wall));
  }

  void remove_floor(std::size_t i) {
    const bim::Room& room = out_.building.rooms[i];
    bool cut = false;
    for (bim::Slab& slab : out_.building.slabs) {
      if (std::abs(slab.z1_m - room.z0_m) > 0.05 || slab.body) continue;
      Polygon2 hole = room.polygon;
      std::reverse(hole.begin(), hole.end());
      slab.polygon.holes.push_back(std::move(hole));
      cut = true;
    }
    if (cut) out_.faults.push_back({FaultKind::missing_floor, "", room.id});
  }

  FaultyBuilding& out_;
  Stream stream_;
};

/// Options of the k-th building: its seed, and a size where the family has one.
Tree options_of(const std::string& family, std::uint64_t k) {
  Tree options = Tree::map();
  options.set("seed", std::to_string(k));
  const auto round = static_cast<int>(k / bim::generators().size() % 7);
  for (const bim::OptionRow& row : bim::generator_options(family)) {
    if (row.key == "rooms") options.set("rooms", std::to_string(2 + round));
    if (row.key == "rows") options.set("rows", std::to_string(1 + round % 4));
    if (row.key == "columns") options.set("columns", std::to_string(2 + round));
    if (row.key == "sides" && round % 2 == 1) options.set("sides", "both");
  }
  return options;
}

const bim::Room* room_named(const bim::Building& building, const std::string& id) {
  const auto found =
      std::find_if(building.rooms.begin(), building.rooms.end(), [&](const bim::Room& room) { return room.id == id; });
  return found == building.rooms.end() ? nullptr : &*found;
}

/// Indices of the faults that a blockage names for a room; none where it names something else.
std::vector<std::size_t> faults_of(const FaultyBuilding& faulty, const sim::Blockage& blockage) {
  std::vector<std::size_t> named;
  for (std::size_t i = 0; i < faulty.faults.size(); ++i) {
    const Fault& fault = faulty.faults[i];
    if (fault.kind == FaultKind::missing_floor) {
      const bim::Room& room = *room_named(faulty.building, fault.where);
      if (blockage.element.empty() &&
          (contains(room.polygon, blockage.at_W) || boundary_distance(room.polygon, blockage.at_W) < 0.5))
        named.push_back(i);
    } else if (blockage.text.find(fault.element) != std::string::npos ||
               blockage.element == "door '" + fault.where + "'") {
      named.push_back(i);
    }
  }
  return named;
}

/// Whether what is said of a room is right: with all of it repaired the room can be reached.
bool is_named(const FaultyBuilding& faulty, const RoomOutOfReach& missed, const std::string& start) {
  std::set<std::size_t> repaired;
  for (std::size_t i = 0; i < faulty.faults.size(); ++i)
    if (faulty.faults[i].kind == FaultKind::missing_floor && faulty.faults[i].where == missed.id &&
        missed.why.rfind("there is no floor in it", 0) == 0)
      repaired.insert(i);
  const bool by_floor = !repaired.empty();
  for (const sim::Blockage& blockage : missed.blockages) {
    const std::vector<std::size_t> named = faults_of(faulty, blockage);
    if (named.empty()) return false;
    repaired.insert(named.begin(), named.end());
  }
  return by_floor || faulty.reachable(start, repaired).contains(missed.id);
}

}  // namespace

std::set<std::string> FaultyBuilding::reachable(const std::string& room, const std::set<std::size_t>& repaired) const {
  std::set<std::string> blocked;
  for (std::size_t i = 0; i < faults.size(); ++i)
    if (!repaired.contains(i)) blocked.insert(faults[i].where);
  std::set<std::string> found = {room};
  std::vector<std::string> open = {room};
  while (!open.empty()) {
    const std::string here = open.back();
    open.pop_back();
    const auto go = [&](const std::string& there) {
      if (!blocked.contains(there) && found.insert(there).second) open.push_back(there);
    };
    for (const bim::VirtualEdge& edge : room_named(building, here)->virtual_edges)
      if (edge.room >= 0 && (edge.b - edge.a).norm() > open_edge_m)
        go(building.rooms[static_cast<std::size_t>(edge.room)].id);
    for (const bim::Opening& door : building.openings) {
      if (door.kind == bim::OpeningKind::window || door.rooms[0] < 0 || door.rooms[1] < 0 || blocked.contains(door.id))
        continue;
      const std::string &a = building.rooms[static_cast<std::size_t>(door.rooms[0])].id,
                        &b = building.rooms[static_cast<std::size_t>(door.rooms[1])].id;
      if (a != here && b != here) continue;
      go(a == here ? b : a);
    }
  }
  return found;
}

std::optional<FaultyBuilding> faulty_building(std::uint64_t k) {
  const std::string family(bim::generators()[k % bim::generators().size()].name);
  const Tree options = options_of(family, k);
  FaultyBuilding out;
  out.what = "building " + std::to_string(k) + ": " + family + " " + write_json(options, 0);
  try {
    out.building = bim::read_plan_text(bim::write_plan(bim::generate(family, options).plan), "faulty");
  } catch (const InputError&) {
    return std::nullopt;
  }
  Spoiler(out, k).spoil();
  return out;
}

FaultyWalk walk_through(const FaultyBuilding& faulty) {
  FaultyWalk result;
  const sim::MultiStoreyPlanner space(faulty.building);
  RoutePlan plan;
  try {
    plan = plan_route(space, {}, {}, {}, walk_length(default_longest_s, Scenario().speed_mps));
  } catch (const InputError& error) {
    result.refused = true;
    const std::string text = error.what();
    const bool says_why = std::any_of(faulty.faults.begin(), faulty.faults.end(), [&](const Fault& fault) {
      return text.find("'" + fault.where + "'") != std::string::npos ||
             (!fault.element.empty() && text.find(fault.element) != std::string::npos) ||
             (fault.kind == FaultKind::missing_floor && text.find("floor") != std::string::npos);
    });
    if (!says_why) result.wrong = "refused without a reason: " + text;
    return result;
  }
  const WalkCoverage walk = walk_coverage(space, plan);
  const auto start = std::find_if(
      faulty.building.rooms.begin(), faulty.building.rooms.end(),
      [&](const bim::Room& room) { return room.storey == plan.storey && contains(room.polygon, plan.start_W); });
  const std::set<std::string> reachable = faulty.reachable(start->id);
  result.reachable = reachable.size();
  result.missed = static_cast<std::size_t>(walk.rooms) - reachable.size();
  for (const RoomOutOfReach& missed : walk.out_of_reach) {
    if (reachable.contains(missed.id))
      result.wrong = missed.id + " can be reached and is said not to be: " + missed.why;
    else if (is_named(faulty, missed, start->id))
      ++result.named;
    else if (result.wrong.empty())
      result.wrong = missed.id + " is not stopped by what is said: " + missed.why;
  }
  // Rooms in reach that the walk leaves out are listed in what is said of it.
  result.entered = static_cast<std::size_t>(walk.on_route) + walk.left_out.size();
  if (result.entered > result.reachable) result.wrong = "the walk enters more rooms than can be reached";
  return result;
}

}  // namespace plumbline::scenarios
