// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/deviation_list.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "bim/model/hull.h"
#include "bim/model/wall_face.h"
#include "scenarios/report/svg.h"

namespace plumbline::scenarios {

namespace {

template <class Element>
const Element* named(const std::vector<Element>& elements, const std::string& id) {
  const auto found =
      std::find_if(elements.begin(), elements.end(), [&](const Element& element) { return element.id == id; });
  return found == elements.end() ? nullptr : &*found;
}

/// The opening's stretch of its wall.
Polygon2 outline_of(const bim::Opening& opening, const bim::Wall& wall) {
  const Eigen::Vector2d e = wall.direction(), near = wall.offset_m * wall.left(),
                        far = (wall.offset_m + wall.thickness_m) * wall.left();
  const Eigen::Vector2d p = wall.a + (opening.s_m - 0.5 * opening.width_m) * e,
                        q = wall.a + (opening.s_m + 0.5 * opening.width_m) * e;
  return {p + near, q + near, q + far, p + far};
}

/// Convex hull of a solid's corners on the ground.
Polygon2 hull_of(const bim::Solid& solid) {
  Polygon2 points;
  for (const Eigen::Vector3d& p : solid.vertices) points.emplace_back(p.head<2>());
  return bim::convex_hull(std::move(points));
}

Eigen::Vector2d middle_of(const Polygon2& polygon) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : polygon) sum += p;
  return sum / static_cast<double>(polygon.size());
}

/// "move_wall" of "w3" as "wall w3 moved".
std::string in_words(const std::string& op, const std::string& element) {
  const std::size_t cut = op.find('_');
  const std::string verb = op.substr(0, cut), kind = cut == std::string::npos ? "" : op.substr(cut + 1) + " ";
  constexpr std::array<std::pair<std::string_view, std::string_view>, 6> words = {
      {{"move", "moved"},
       {"remove", "not built"},
       {"add", "added"},
       {"tilt", "tilted"},
       {"reshape", "with another outline"},
       {"drop", "no longer a room of its own"}}};
  for (const auto& [known, word] : words)
    if (known == verb) return kind + element + " " + std::string(word);
  return verb + " " + kind + element;
}

}  // namespace

ElementOutline outline_in(const bim::Building& building, const std::string& id) {
  if (const bim::Wall* wall = named(building.walls, id)) return {wall->storey, bim::footprint(*wall)};
  if (const bim::Opening* opening = named(building.openings, id); opening != nullptr && opening->wall >= 0) {
    const bim::Wall& wall = building.walls[static_cast<std::size_t>(opening->wall)];
    return {wall.storey, outline_of(*opening, wall)};
  }
  if (const bim::Column* column = named(building.columns, id)) return {column->storey, column->footprint};
  if (const bim::Obstacle* obstacle = named(building.obstacles, id)) return {obstacle->storey, hull_of(obstacle->body)};
  if (const bim::Room* room = named(building.rooms, id)) return {room->storey, {}};
  return {};
}

std::vector<ReportDeviation> report_deviations(const bim::PlannedAndBuilt& site, int storey) {
  std::vector<ReportDeviation> deviations;
  for (const bim::Change& change : site.changes) {
    const ElementOutline planned = outline_in(site.as_planned, change.element);
    const ElementOutline built = outline_in(site.as_built, change.element);
    if (planned.storey != storey && built.storey != storey) continue;
    deviations.push_back({change.op, change.element, planned.polygon_W, built.polygon_W});
  }
  return deviations;
}

std::string describe(const ReportDeviation& deviation) {
  std::string text = in_words(deviation.op, deviation.element);
  if (!deviation.planned_W.empty() && !deviation.built_W.empty()) {
    const Eigen::Vector2d moved = middle_of(deviation.built_W) - middle_of(deviation.planned_W);
    std::string by;
    for (const int axis : {0, 1})
      if (std::abs(moved[axis]) >= 0.0005)
        by += (by.empty() ? "" : ", ") + svg::number(std::abs(moved[axis])) + " m towards " +
              (moved[axis] > 0.0 ? "+" : "-") + "xy"[axis];
    if (!by.empty()) text += ": " + by;
  }
  if (!deviation.judged) return text;
  return text + (deviation.seen_at_s ? "; in sight from " + svg::number(*deviation.seen_at_s, 1) + " s on"
                                     : "; never in sight of the robot");
}

std::string draw_deviations(const std::vector<ReportDeviation>& deviations) {
  std::string out;
  for (const ReportDeviation& deviation : deviations) {
    if (deviation.planned_W.empty() && deviation.built_W.empty()) continue;
    out += "<g><title>" + svg::escape(describe(deviation)) + "</title>";
    if (!deviation.built_W.empty()) out += svg::polygon(deviation.built_W, "class=\"asbuilt\"");
    if (!deviation.planned_W.empty()) out += svg::polygon(deviation.planned_W, "class=\"planned\"");
    out += "</g>";
  }
  return out;
}

std::string list_deviations(const std::vector<ReportDeviation>& deviations) {
  if (deviations.empty()) return "";
  std::string out =
      "<section class=\"card\"><h2>Built otherwise than planned</h2><p class=\"facts\">Localization methods get the "
      "plan; the sensor sees what was built. In the map: orange is what stands, dashed where the plan has it.</p><ul>";
  for (const ReportDeviation& deviation : deviations) out += "<li>" + svg::escape(describe(deviation)) + "</li>";
  return out + "</ul></section>";
}

}  // namespace plumbline::scenarios
