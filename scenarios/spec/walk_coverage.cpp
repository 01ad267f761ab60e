// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/walk_coverage.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include "scenarios/spec/entered_room.h"
#include "scenarios/spec/room_places.h"
#include "sim/route/clearance_map.h"
#include "sim/route/speed_profile.h"

namespace plumbline::scenarios {

namespace {

constexpr double short_m = 10.0;         ///< a shorter walk shows little
constexpr double least_share_out = 0.1;  ///< of a room's walkable floor, for a word on it

/// Speed of a walk through rooms, whose turns at each goal are on the spot.
constexpr double slower_by = 1.8;
constexpr double stand_s = 20.0;

std::string metres(double x, double steps = 1e2) { return format_number(std::round(x * steps) / steps) + " m"; }

std::string name_of(const bim::Room& room) { return room.name.empty() ? room.id : room.name; }

/// Looks at the rooms of one storey from the start of a walk.
class Surveyor {
 public:
  Surveyor(const sim::MultiStoreyPlanner& space, const RoutePlan& plan)
      : building_(space.building()),
        space_(space),
        plan_(plan),
        places_(space.building(), space, sim::FloorPoint{plan.storey, plan.start_W}) {}

  [[nodiscard]] bool is_entered(int index) const { return enters_room(space_, plan_.waypoints, index); }

  [[nodiscard]] bool in_reach(int index) const {
    const std::optional<sim::FloorPoint>& place = places_.of(index);
    if (!place) return false;
    const sim::ClearanceMap& floor = space_.storey(plan_.storey);
    if (const int region = floor.region(plan_.start_W); region >= 0 && region == floor.region(place->p_W)) return true;
    return !building_.stairs.empty() && !space_.path({plan_.storey, plan_.start_W}, *place).empty();
  }

  /// Share of the floor of a room where a robot could be that it does not get to from the start.
  [[nodiscard]] double share_out_of_reach(int index) const {
    const bim::Room& room = building_.rooms[static_cast<std::size_t>(index)];
    const sim::ClearanceMap& floor = space_.storey(plan_.storey);
    const int here = floor.region(plan_.start_W);
    if (here < 0) return 0.0;
    // Another piece of the floor where the way leads over stairs and back.
    const int place = in_reach(index) ? floor.region(places_.of(index)->p_W) : here;
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& p : room.polygon) box.extend(p);
    const double step = 2.0 * floor.grid().cell;
    double all = 0.0, out = 0.0;
    for (double y = box.min().y() + 0.5 * step; y < box.max().y(); y += step)
      for (double x = box.min().x() + 0.5 * step; x < box.max().x(); x += step) {
        const int region = floor.region({x, y});
        if (region < 0 || !room.contains({x, y})) continue;
        ++all;
        if (region != here && region != place) ++out;
      }
    return all > 0.0 ? out / all : 0.0;
  }

  [[nodiscard]] RoomOutOfReach why_not(int index) {
    const bim::Room& room = building_.rooms[static_cast<std::size_t>(index)];
    RoomOutOfReach out{room.id, name_of(room), "", {}};
    const sim::ClearanceMap& floor = space_.storey(plan_.storey);
    const std::optional<std::size_t> goal = floor.freest_cell(room);
    if (goal && places_.has_floor(index) && floor.cell_clearance(*goal) > 0.0)
      out.blockages = blockages().before(floor.grid().center(*goal));
    constexpr std::size_t most = 2;
    for (std::size_t i = 0; i < std::min(most, out.blockages.size()); ++i)
      out.why += (out.why.empty() ? "" : "; ") + out.blockages[i].text;
    if (out.blockages.size() > most) out.why += "; and " + std::to_string(out.blockages.size() - most) + " more";
    if (out.why.empty()) out.why = places_.why_none(index);
    return out;
  }

 private:
  [[nodiscard]] const sim::Blockages& blockages() {
    if (!blockages_)
      blockages_ =
          std::make_unique<sim::Blockages>(building_, plan_.storey, space_.storey(plan_.storey), plan_.start_W);
    return *blockages_;
  }

  const bim::Building& building_;
  const sim::MultiStoreyPlanner& space_;
  const RoutePlan& plan_;
  RoomPlaces places_;
  std::unique_ptr<sim::Blockages> blockages_;
};

/// What stops the robot first on the way to most of the rooms out of reach.
struct Culprit {
  sim::Blockage blockage;
  std::size_t rooms = 0;
};

Culprit main_culprit(const WalkCoverage& walk) {
  std::vector<Culprit> culprits;
  for (const RoomOutOfReach& room : walk.out_of_reach) {
    if (room.blockages.empty()) continue;
    const auto same = std::find_if(culprits.begin(), culprits.end(), [&](const Culprit& culprit) {
      return culprit.blockage.text == room.blockages.front().text;
    });
    if (same == culprits.end())
      culprits.push_back({room.blockages.front(), 1});
    else
      ++same->rooms;
  }
  const auto most = std::max_element(culprits.begin(), culprits.end(),
                                     [](const Culprit& a, const Culprit& b) { return a.rooms < b.rooms; });
  return most == culprits.end() ? Culprit{} : *most;
}

std::string help_for(const Culprit& culprit) {
  const std::string behind = culprit.blockage.text + " (" + std::to_string(culprit.rooms) +
                             (culprit.rooms == 1 ? " room lies" : " rooms lie") + " behind it); ";
  switch (culprit.blockage.kind) {
    case sim::BlockageKind::closed_door:
      return behind + "`doors: open` in a scenario would open it";
    case sim::BlockageKind::furniture:
      return behind + "`furniture: false` in a scenario would clear it";
    case sim::BlockageKind::structure:
      break;
  }
  return behind + "correct it in the building, or give a `start` on the other side of it";
}

}  // namespace

bim::Building walked_building(const bim::PlannedAndBuilt& site) {
  bim::Building walked = site.as_built;
  for (const bim::Room& planned : site.as_planned.rooms) {
    const auto same = [&](const bim::Room& room) { return room.id == planned.id; };
    if (std::none_of(walked.rooms.begin(), walked.rooms.end(), same)) walked.rooms.push_back(planned);
  }
  return walked;
}

WalkCoverage walk_coverage(const sim::MultiStoreyPlanner& space, const RoutePlan& plan) {
  const bim::Building& building = space.building();
  const bim::Storey& storey = building.storeys.at(static_cast<std::size_t>(plan.storey));
  WalkCoverage walk;
  walk.storey = storey.name.empty() ? storey.id : storey.name;
  walk.floor_assumed =
      !sim::has_known_floor(building, plan.storey, space.storey(plan.storey).ground_W(), sim::RouteConfig());
  walk.planned_m = plan.length_m;
  walk.stairs_m = plan.stairs_m;
  walk.storeys_out_of_reach = plan.storeys_out_of_reach;
  if (!plan.waypoints.empty()) walk.end_W = plan.waypoints.back().p_W.head<2>();
  for (const std::string& id : plan.rooms) {
    const bool is_room =
        std::any_of(building.rooms.begin(), building.rooms.end(), [&](const bim::Room& room) { return room.id == id; });
    if (is_room && std::find(walk.route_rooms.begin(), walk.route_rooms.end(), id) == walk.route_rooms.end())
      walk.route_rooms.push_back(id);
  }
  Surveyor surveyor(space, plan);
  for (std::size_t i = 0; i < building.rooms.size(); ++i) {
    const bim::Room& room = building.rooms[i];
    if (room.storey != plan.storey) {
      walk.elsewhere += surveyor.is_entered(static_cast<int>(i)) ? 1 : 0;
      continue;
    }
    ++walk.rooms;
    const bool entered = surveyor.is_entered(static_cast<int>(i));
    const bool in_reach = entered || surveyor.in_reach(static_cast<int>(i));
    walk.on_route += entered ? 1 : 0;
    walk.in_reach += in_reach ? 1 : 0;
    if (const double share = in_reach ? surveyor.share_out_of_reach(static_cast<int>(i)) : 0.0; share > least_share_out)
      walk.in_part.push_back({name_of(room), share});
    if (!in_reach)
      walk.out_of_reach.push_back(surveyor.why_not(static_cast<int>(i)));
    else if (!entered) {
      walk.left_out.push_back(name_of(room));
      walk.at_edge += std::find(walk.route_rooms.begin(), walk.route_rooms.end(), room.id) != walk.route_rooms.end();
    }
  }
  return walk;
}

WalkCoverage walk_coverage(const bim::PlannedAndBuilt& site, const Scenario& resolved) {
  const bim::Building walked = walked_building(site);
  const sim::MultiStoreyPlanner space(walked);
  return walk_coverage(space, plan_route(space, resolved.start, resolved.route, {}));
}

double walk_duration(double length_m, double stairs_m, double speed_mps) {
  const double walk_s = (length_m - stairs_m) / speed_mps;
  const double climb_s = stairs_m / std::min(speed_mps, sim::SpeedConfig().stairs_mps);
  return std::ceil(slower_by * (walk_s + climb_s) + stand_s);
}

double walk_length(double duration_s, double speed_mps) {
  return std::max(0.0, duration_s - stand_s) * speed_mps / slower_by;
}

std::vector<std::string> walk_warnings(const WalkCoverage& walk) {
  std::vector<std::string> warnings;
  if (walk.rooms == 0 && walk.elsewhere == 0)
    warnings.push_back("no rooms are known on " + walk.storey +
                       ": the walk goes round its floor, methods that localize have nowhere to begin, and `rooms.*` "
                       "are not scored");
  if (walk.floor_assumed)
    warnings.push_back("neither slabs nor rooms say where the floor of " + walk.storey +
                       " is; it is taken to be level everywhere, and a slab in the building would say where it ends");
  for (const std::string& storey : walk.storeys_out_of_reach) warnings.push_back("`storeys: all` leaves out " + storey);
  for (const RoomInPart& room : walk.in_part)
    warnings.push_back(std::to_string(std::lround(100.0 * room.share)) + " % of the floor of " + room.name +
                       " where the robot could be is out of reach");
  if (2 * walk.in_reach < walk.rooms) {
    std::string text = "the start reaches only " + std::to_string(walk.in_reach) + " of the " +
                       std::to_string(walk.rooms) + " rooms on " + walk.storey;
    const Culprit culprit = main_culprit(walk);
    warnings.push_back(text + (culprit.rooms > 0 ? ": " + help_for(culprit) : "; see what is said of each of them"));
  }
  if (walk.planned_m < short_m)
    warnings.push_back("the walk is only " + metres(walk.planned_m, 10.0) + " long; `route: {rooms: [...], loop: 3}` " +
                       "in a scenario makes it longer, more `times` of a shuttle, or a `start` on another storey");
  return warnings;
}

std::vector<std::string> out_of_reach_lines(const WalkCoverage& walk, std::size_t most) {
  std::vector<std::pair<std::string, std::string>> groups;  // why, rooms
  for (const RoomOutOfReach& room : walk.out_of_reach) {
    const auto same = std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.first == room.why; });
    if (same == groups.end())
      groups.emplace_back(room.why, room.name);
    else
      same->second += ", " + room.name;
  }
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < std::min(most, groups.size()); ++i)
    lines.push_back(groups[i].second + ": " + groups[i].first);
  if (groups.size() > most) lines.push_back("and others for " + std::to_string(groups.size() - most) + " more reasons");
  return lines;
}

std::vector<std::string> left_out_lines(const WalkCoverage& walk) {
  std::vector<std::string> lines;
  const auto rooms = [](std::size_t count) { return std::to_string(count) + (count == 1 ? " room" : " rooms"); };
  if (walk.at_edge > 0)
    lines.push_back("passed at their edge only, where their most free floor is: " + rooms(walk.at_edge));
  if (walk.left_out.size() > walk.at_edge)
    lines.push_back("left out: " + rooms(walk.left_out.size() - walk.at_edge) +
                    " in reach, since a default walk takes at most " + format_number(default_longest_s / 60.0) +
                    " minutes; a scenario with `route: {rooms: all}` and a longer `duration_s` walks them too");
  return lines;
}

std::string walk_sentence(const WalkCoverage& walk) {
  std::string text = metres(walk.planned_m, 10.0);
  if (walk.rooms == 0) return text + " on " + walk.storey + ", where no rooms are known";
  text += " through " + std::to_string(walk.on_route) + " of the " + std::to_string(walk.rooms) +
          (walk.rooms == 1 ? " room on " : " rooms on ") + walk.storey;
  if (walk.in_reach > walk.on_route && walk.in_reach < walk.rooms)
    text += ", of which " + std::to_string(walk.in_reach) + " are in reach";
  if (walk.elsewhere > 0)
    text +=
        ", and " + std::to_string(walk.elsewhere) + (walk.elsewhere == 1 ? " room" : " rooms") + " of other storeys";
  return text;
}

Tree to_results(const WalkCoverage& walk, const std::vector<std::string>& warnings) {
  Tree tree = Tree::map();
  tree.set("storey", walk.storey).set("planned_m", walk.planned_m);
  if (walk.rooms > 0) {
    Tree rooms = Tree::map();
    rooms.set("on_storey", walk.rooms).set("in_reach", walk.in_reach).set("on_route", walk.on_route);
    if (walk.elsewhere > 0) rooms.set("elsewhere", walk.elsewhere);
    tree.set("rooms", std::move(rooms));
  }
  Tree out = Tree::list(), left = Tree::list(), said = Tree::list();
  for (const RoomOutOfReach& room : walk.out_of_reach)
    out.push(Tree::map().set("room", room.id).set("name", room.name).set("why", room.why));
  for (const std::string& name : walk.left_out) left.push(name);
  for (const std::string& warning : warnings) said.push(warning);
  return tree.set("out_of_reach", std::move(out)).set("left_out", std::move(left)).set("warnings", std::move(said));
}

}  // namespace plumbline::scenarios
