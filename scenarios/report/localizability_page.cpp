// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/localizability_page.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "bim/plan/plan.h"
#include "scenarios/report/alike_list.h"
#include "scenarios/report/map_drawing.h"
#include "scenarios/report/page.h"
#include "scenarios/report/svg.h"

namespace plumbline::scenarios {

namespace {

constexpr std::string_view green = "var(--sure)", red = "var(--never)";
/// By the length of the walk: up to these metres each, then beyond.
constexpr std::array<double, 3> amber_up_to_m = {2.0, 5.0, 10.0};
constexpr std::array<std::string_view, 4> ambers = {"var(--walk0)", "var(--walk1)", "var(--walk2)", "var(--walk3)"};

std::string_view colour_of(const CellAnswer& answer) {
  if (!answer.walk_m) return red;
  if (*answer.walk_m == 0.0) return green;
  const auto at = std::lower_bound(amber_up_to_m.begin(), amber_up_to_m.end(), *answer.walk_m);
  return ambers[static_cast<std::size_t>(at - amber_up_to_m.begin())];
}

std::string title_of(const CellAnswer& answer) {
  const std::string aliases = std::to_string(answer.aliases) + (answer.aliases == 1 ? " other place" : " other places");
  if (!answer.walk_m) return "aliased with " + aliases + "; no walk on this storey resolves it";
  if (*answer.walk_m == 0.0) return "one scan suffices";
  return "aliased with " + aliases + "; resolved after a walk of " + svg::number(*answer.walk_m, 1) + " m";
}

std::string cell_square(const MapCell& cell, const CellAnswer& answer, double step_m) {
  const double s = step_m;
  return "<rect x=\"" + svg::number(cell.p_W.x() - 0.5 * s) + "\" y=\"" + svg::number(-cell.p_W.y() - 0.5 * s) +
         "\" width=\"" + svg::number(s) + "\" height=\"" + svg::number(s) + "\" fill=\"" +
         std::string(colour_of(answer)) + "\"><title>" + title_of(answer) + "</title></rect>";
}

std::string legend() {
  const auto item = [](std::string_view colour, const std::string& text) {
    return "<span><svg viewBox=\"0 0 34 10\"><rect width=\"34\" height=\"10\" fill=\"" + std::string(colour) +
           "\"/></svg>" + text + "</span>";
  };
  return "<div class=\"key\">" + item(green, "one scan suffices") + item(ambers[0], "a walk of up to 2 m suffices") +
         item(ambers[1], "up to 5 m") + item(ambers[2], "up to 10 m") + item(ambers[3], "further") +
         item(red, "no walk on the storey suffices") + item("var(--thing)", "column, furniture") +
         item("var(--deciding)", "what distinguishes places that look alike, by number") + "</div>";
}

std::string percent(int part, int whole) { return whole == 0 ? "–" : svg::number(100.0 * part / whole, 1) + " %"; }

std::string share_row(const std::string& name, const MapShare& s) {
  const auto cell = [](const char* head, const std::string& text) {
    return "<td class=\"num" + std::string(text == "–" ? " none" : "") + "\" data-head=\"" + std::string(head) + "\">" +
           text + "</td>";
  };
  return "<tr><td>" + svg::escape(name) + "</td>" + cell("places", std::to_string(s.cells)) +
         cell("one scan", percent(s.one_scan, s.cells)) + cell("a walk", percent(s.walk, s.cells)) +
         cell("median m", s.walk > 0 ? svg::number(s.walk_median_m, 1) : "–") +
         cell("longest m", s.walk > 0 ? svg::number(s.walk_max_m, 1) : "–") + cell("never", percent(s.never, s.cells)) +
         cell("aliases, most", std::to_string(s.aliases_max)) + "</tr>";
}

/// What pages show of one condition.
class ConditionPage {
 public:
  ConditionPage(const RunBuilding& building, const BuildingMap& map, bool compass)
      : building_(building), map_(map), compass_(compass) {
    input_.plan = *building.plan_as_planned();
    input_.obstacles = obstacles_of(building.as_planned(), input_.plan);
    input_.flights = flights_of(building.as_planned());
    for (bim::PlanRoom& room : input_.plan.rooms)
      for (const bim::Room& named : building.as_planned().rooms)
        if (named.id == room.name && !named.name.empty()) {
          room.name = named.name;
          break;
        }
    for (const Floor& floor : map.floors) input_.storeys.push_back({static_cast<int>(floor.storey), "", {}});
  }

  /// folds: closed at first on a phone, where all of them would be many screens long.
  [[nodiscard]] std::string card(bool folds) const {
    const std::string title = compass_ ? "Heading known from a compass" : "Heading unknown";
    std::string out = folds ? "<details class=\"card fold\" open><summary>" + title + "</summary><div class=\"maps\">"
                            : "<section class=\"card\"><h2>" + title + "</h2><div class=\"maps\">";
    for (std::size_t f = 0; f < map_.floors.size(); ++f) out += "<div>" + draw(f) + "</div>";
    return out + "</div>" + legend() + storeys_table() + rooms_table() +
           list_alike(building_, shown_alike(map_, compass_)) + (folds ? "</details>\n" : "</section>\n");
  }

 private:
  [[nodiscard]] const CellAnswer& answer(const MapCell& cell) const {
    return compass_ ? cell.compass : cell.unknown.value();
  }

  [[nodiscard]] std::string draw(std::size_t f) const {
    const auto storey = static_cast<int>(map_.floors[f].storey);
    const std::string name = svg::escape(name_of(building_.as_planned().storeys[map_.floors[f].storey]));
    std::string out = "<p class=\"storey\">" + name + "</p>" + open_map(bounds(input_), "where on " + name);
    std::string cells, plan = draw_plan(input_, storey);
    for (const MapCell& cell : map_.map.cells)
      if (cell.floor == f) cells += cell_square(cell, answer(cell), map_.options.step_m);
    // Rooms are filled: cells lie over them, walls over cells.
    const std::size_t walls = std::min(plan.find("<line"), plan.size());
    return out + plan.substr(0, walls) + cells + plan.substr(walls) +
           draw_deciding(building_, shown_alike(map_, compass_), storey) + room_names(input_, storey) +
           draw_scale(bounds(input_)) + "</svg>";
  }

  /// rows: under the heads of their columns.
  [[nodiscard]] static std::string table(const std::string& label, const std::string& rows) {
    return "<div class=\"scroll\"><table class=\"stacked\" aria-label=\"" + label +
           "\"><tr class=\"heads\"><th></th><th class=\"num\">places</th><th class=\"num\">one scan</th>"
           "<th class=\"num\">a walk</th><th class=\"num\">median m</th><th class=\"num\">longest m</th>"
           "<th class=\"num\">never</th><th class=\"num\">aliases, most</th></tr>" +
           rows + "</table></div>";
  }

  [[nodiscard]] std::string storeys_table() const {
    std::string rows;
    for (std::size_t f = 0; f < map_.floors.size(); ++f) {
      const bim::Storey& storey = building_.as_planned().storeys[map_.floors[f].storey];
      rows +=
          share_row(name_of(storey), share_of(map_, compass_, [&](const MapCell& cell) { return cell.floor == f; }));
    }
    for (const std::size_t storey : map_.bare) rows += share_row(name_of(building_.as_planned().storeys[storey]), {});
    return table("places by storey", rows);
  }

  [[nodiscard]] std::string rooms_table() const {
    std::string rows;
    int count = 0;
    for (const bim::Room& room : building_.as_planned().rooms) {
      const MapShare share = share_of(map_, compass_, [&](const MapCell& cell) {
        return static_cast<int>(map_.floors[cell.floor].storey) == room.storey && room.contains(cell.p_W);
      });
      if (share.cells == 0) continue;
      rows += share_row(room.name.empty() ? room.id : room.name, share);
      ++count;
    }
    if (count == 0) return "";
    return "<details class=\"fold\" open><summary>By room: " + std::to_string(count) + "</summary>" +
           table("places by room", rows) + "</details>";
  }

  const RunBuilding& building_;
  const BuildingMap& map_;
  bool compass_;
  ReportInput input_;
};

/// first: of the page; what comes after it folds.
std::string answer(const std::string& title, const RunBuilding& building, const BuildingMap& map, bool first) {
  std::string out = "<h2>" + title + "</h2>\n";
  const bool both = !map.options.compass_only;
  if (both) out += ConditionPage(building, map, false).card(!first);
  return out + ConditionPage(building, map, true).card(both || !first);
}

}  // namespace

std::string localizability_page(const RunBuilding& building, const std::string& name, const BuildingMaps& maps) {
  const BuildingMap& map = maps.building;
  std::string page = open_page(name) + "<header><h1>Localizability: " + svg::escape(name) +
                     "</h1><span class=\"facts\">a place every " + svg::number(map.options.step_m) +
                     " m, aliased poses on " + (map.options.across ? "all storeys" : "the same storey") +
                     "</span></header>\n";
  if (const std::string scanned = scanned_text(building); !scanned.empty())
    page += "<p class=\"facts\">" + scanned + "</p>\n";
  page += answer("By the building alone", building, map, true);
  if (maps.with_furniture)
    page += answer("With the furniture as planned", building, *maps.with_furniture, false);
  else
    page +=
        "<p class=\"facts\">The plan has no furniture or other object that may have moved; the answer is the same with "
        "it.</p>\n";
  return page +
         "<p class=\"facts\">Two places are aliased where a levelled LiDAR of 8 x 360 beams measures the same at both, "
         "within noise. A walk resolves a place when no aliased pose explains the scans at all its "
         "steps. The scan sees everything that stands in the building; by the building alone, what may have moved is "
         "no "
         "part of the plan. Click a map, then zoom with the wheel or + and -, drag or arrow keys to move, 0 for all of "
         "it.</p></main><script>" +
         std::string(map_script()) + "</script></body></html>\n";
}

}  // namespace plumbline::scenarios
