// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/walk_page.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "scenarios/report/map_drawing.h"
#include "scenarios/report/page.h"
#include "scenarios/report/svg.h"
#include "scenarios/report/walk_list.h"
#include "scenarios/spec/room_places.h"
#include "scenarios/spec/walk_coverage.h"

namespace plumbline::scenarios {

namespace {

constexpr std::string_view floor_colour = "var(--reached)", elsewhere_colour = "var(--elsewhere)", red = "var(--never)",
                           walk_colour = "var(--walked)";
constexpr int most_rows = 400;  ///< of floor drawn, so that a page of a large building opens
constexpr std::size_t most_lines = 8;

std::string name_of(const bim::Room& room) { return room.name.empty() ? room.id : room.name; }

/// Walkable floor in rows: what is reached from the start, and what is walkable and is not.
std::string draw_floor(const sim::ClearanceMap& space, const Eigen::Vector2d& start_W) {
  const GridFrame& grid = space.grid();
  const int stride = 1 + (grid.ny - 1) / most_rows;
  const int here = space.region(start_W);
  std::string rows[2];
  for (int j = stride / 2; j < grid.ny; j += stride) {
    int from = 0, kind = -1;
    const auto end_run = [&](int to) {
      if (kind < 0) return;
      const Eigen::Vector2d p = grid.center(from, j);
      rows[kind] += "M" + svg::number(p.x() - 0.5 * grid.cell, 2) + " " + svg::number(-p.y(), 2) + "h" +
                    svg::number(grid.cell * (to - from), 2);
    };
    for (int i = 0; i < grid.nx; ++i) {
      const int region = space.region(grid.center(i, j));
      const int now = region < 0 ? -1 : region == here ? 0 : 1;
      if (now == kind) continue;
      end_run(i);
      kind = now;
      from = i;
    }
    end_run(grid.nx);
  }
  constexpr double overlap = 1.2;  // or the paper shows between the rows
  const auto path = [&](const std::string& d, std::string_view colour) {
    return "<path d=\"" + d + "\" stroke=\"" + std::string(colour) + "\" stroke-width=\"" +
           svg::number(overlap * grid.cell * stride, 3) + "\" fill=\"none\"/>";
  };
  return path(rows[1], elsewhere_colour) + path(rows[0], floor_colour);
}

/// Floor that is reached from the start may lie outside the walls, and where there are none.
void add_floor(const sim::ClearanceMap& space, const Eigen::Vector2d& start_W, MapBox& box) {
  const GridFrame& grid = space.grid();
  const int here = space.region(start_W);
  for (int j = 0; here >= 0 && j < grid.ny; ++j)
    for (int i = 0; i < grid.nx; ++i)
      if (space.region(grid.center(i, j)) == here) box.add(grid.center(i, j));
}

/// Red over rooms out of reach, and a mark where the way to each of them is blocked; reasons show on hovering.
std::string draw_reasons(const bim::Building& building, const WalkCoverage& walk) {
  std::string out;
  std::set<std::pair<double, double>> marked;
  for (const RoomOutOfReach& missed : walk.out_of_reach) {
    const auto room = std::find_if(building.rooms.begin(), building.rooms.end(),
                                   [&](const bim::Room& candidate) { return candidate.id == missed.id; });
    out += svg::polygon(room->polygon, "fill=\"" + std::string(red) + "\" fill-opacity=\".22\"",
                        missed.name + ": " + missed.why);
    for (const sim::Blockage& blockage : missed.blockages)
      if (marked.emplace(blockage.at_W.x(), blockage.at_W.y()).second)
        out += "<g><title>" + svg::escape(blockage.text) + "</title>" +
               svg::circle(blockage.at_W, 0.25,
                           "fill=\"var(--paper)\" stroke=\"" + std::string(red) + "\" stroke-width=\".12\"") +
               "</g>";
  }
  return out;
}

std::string draw_names(const bim::Building& building, int storey) {
  std::string out;
  for (const bim::Room& room : building.rooms) {
    if (room.storey != storey || room.polygon.empty() || name_of(room).size() > 18) continue;
    out += svg::text(room_name_place(room.polygon).from, name_of(room), "");
  }
  return out;
}

std::string key() {
  const auto item = [](std::string_view colour, const std::string& text) {
    return "<span><svg viewBox=\"0 0 34 10\"><rect width=\"34\" height=\"10\" fill=\"" + std::string(colour) +
           "\"/></svg>" + text + "</span>";
  };
  return "<div class=\"key\">" + item(floor_colour, "floor in reach of the start") +
         item(elsewhere_colour, "floor out of reach") + item("var(--shade)", "room out of reach") +
         item(walk_colour, "the default walk, from its start (dot)") +
         "<span>ring: what stops the robot (hover for why)</span></div>";
}

/// What pages show of one storey.
class StoreyCard {
 public:
  StoreyCard(const bim::PlannedAndBuilt& site, const sim::MultiStoreyPlanner& space, int storey)
      : building_(space.building()), space_(space), storey_(storey) {
    bim::Plan plan = bim::make_plan(site.as_built);
    input_.obstacles = obstacles_of(site.as_built, plan);
    input_.flights = flights_of(site.as_built);
    input_.plan = std::move(plan);
    const bim::Storey& of = building_.storeys[static_cast<std::size_t>(storey)];
    name_ = of.name.empty() ? of.id : of.name;
    input_.storeys.push_back({storey, name_, {}});
  }

  /// Of a walk that begins in a room.
  void add_to(WalkPage& page, int start_room) const {
    Start start;
    start.room = building_.rooms[static_cast<std::size_t>(start_room)].id;
    RoutePlan plan;
    std::string refused;
    const Scenario defaults;
    try {
      plan = plan_route(space_, start, Route{}, {}, walk_length(default_longest_s, defaults.speed_mps));
    } catch (const InputError& error) {
      refused = error.what();
      Route stay;
      stay.rooms = {};
      plan = plan_route(space_, start, stay, {});
    }
    const WalkCoverage walk = walk_coverage(space_, plan);
    const std::vector<std::string> warnings = walk_warnings(walk);
    Tree results = to_results(walk, warnings);
    page.html +=
        "<section class=\"card\"><h2>" + svg::escape(name_) + "</h2>" + draw(plan, walk) + key() + "</section>\n";
    if (!refused.empty()) page.html += "<p class=\"verdict bad\">" + svg::escape(refused) + "</p>";
    page.html += list_walk(&results) + "\n";
    page.lines.push_back(name_ + ": " + (refused.empty() ? walk_sentence(walk) : refused));
    for (const std::string& line : out_of_reach_lines(walk, most_lines))
      page.lines.push_back("  out of reach: " + line);
    for (const std::string& line : left_out_lines(walk)) page.lines.push_back("  " + line);
    for (const std::string& warning : warnings) page.lines.push_back("  warning: " + warning);
    if (!refused.empty()) results.set("refused", refused);
    page.storeys.push(std::move(results));
  }

  /// Where the robot can turn round in none of its rooms.
  void add_without_start(WalkPage& page, std::ptrdiff_t rooms) const {
    const std::string why = "The robot can turn round in none of its " + std::to_string(rooms) + " rooms.";
    page.html += "<section class=\"card\"><h2>" + svg::escape(name_) + "</h2><p class=\"verdict bad\">" + why +
                 "</p></section>\n";
    page.lines.push_back(name_ + ": " + why);
    page.storeys.push(Tree::map().set("storey", name_).set("refused", why));
  }

 private:
  [[nodiscard]] std::string draw(const RoutePlan& plan, const WalkCoverage& walk) const {
    std::vector<Eigen::Vector2d> way;
    for (const sim::Waypoint& waypoint : plan.waypoints) way.emplace_back(waypoint.p_W.head<2>());
    const std::string drawn = draw_plan(input_, storey_);
    const std::size_t walls = std::min(drawn.find("<line"), drawn.size());
    MapBox box = bounds(input_);
    add_floor(space_.storey(storey_), plan.start_W, box);
    return open_map(box, "where the robot can walk on " + name_) + drawn.substr(0, walls) +
           draw_floor(space_.storey(storey_), plan.start_W) + draw_reasons(building_, walk) + drawn.substr(walls) +
           svg::polyline(way, "fill=\"none\" stroke=\"" + std::string(walk_colour) + "\" stroke-width=\".09\"") +
           svg::circle(plan.start_W, 0.22, "fill=\"" + std::string(walk_colour) + "\"") +
           draw_names(building_, storey_) + "</svg>";
  }

  const bim::Building& building_;
  const sim::MultiStoreyPlanner& space_;
  int storey_;
  std::string name_;
  ReportInput input_;
};

/// Why the default walk of a building without rooms is refused; empty where it is not.
std::string why_no_round(const sim::MultiStoreyPlanner& space) {
  try {
    (void)plan_route(space, {}, {}, {});
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

}  // namespace

WalkPage walk_page(const bim::PlannedAndBuilt& site, const std::string& name) {
  const bim::Building walked = walked_building(site);
  const sim::MultiStoreyPlanner space(walked);
  const RoomPlaces places(walked, space);
  WalkPage page;
  page.html = open_page(name) + "<header><h1>Where the robot can walk: " + svg::escape(name) + "</h1></header>\n";
  for (std::size_t i = 0; i < walked.storeys.size(); ++i) {
    const int storey = static_cast<int>(i);
    const auto rooms = std::count_if(walked.rooms.begin(), walked.rooms.end(),
                                     [&](const bim::Room& room) { return room.storey == storey; });
    if (rooms == 0) continue;
    const StoreyCard card(site, space, storey);
    const int start = places.start_on(storey).room;
    if (start >= 0)
      card.add_to(page, start);
    else
      card.add_without_start(page, rooms);
  }
  if (page.lines.empty()) {
    const std::string refused = walked.rooms.empty() ? why_no_round(space) : "";
    const std::string why = refused.empty() ? "No rooms are known on any storey; `run` walks round the floor."
                                            : "No rooms are known on any storey, and `run` refuses: " + refused;
    page.html += "<p class=\"verdict bad\">" + svg::marked_up(why) + "</p>";
    page.lines.push_back(why);
  }
  page.html += "</main><script>" + std::string(map_script()) + "</script></body></html>\n";
  return page;
}

}  // namespace plumbline::scenarios
