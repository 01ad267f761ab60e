// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/alike_list.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "scenarios/localizability/constants.h"
#include "scenarios/report/deviation_list.h"
#include "scenarios/report/svg.h"

namespace plumbline::scenarios {

namespace {

std::string point(const Eigen::Vector2d& p) { return "(" + svg::number(p.x(), 1) + ", " + svg::number(p.y(), 1) + ")"; }

std::string room_name(const bim::Building& plan, int index) {
  if (index < 0) return "no room";
  const bim::Room& room = plan.rooms[static_cast<std::size_t>(index)];
  return room.name.empty() ? room.id : room.name;
}

/// "kitchen and store; office with itself"; at most three.
std::string rooms_text(const bim::Building& plan, const std::vector<std::pair<int, int>>& rooms) {
  constexpr std::size_t most = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, rooms.size()); ++i) {
    const auto& [a, b] = rooms[i];
    text += (i == 0 ? "" : "; ") + room_name(plan, a) + (a == b ? " with itself" : " and " + room_name(plan, b));
  }
  return text + (rooms.size() > most ? "; and " + std::to_string(rooms.size() - most) + " more" : "");
}

std::string distinction_text(const std::optional<Distinction>& by) {
  if (!by) return "nothing on these floors";
  return by->element + ", " +
         (by->missing ? "which is not where the other pose would have it" : "which only one of them sees") + " (" +
         svg::number(100.0 * by->share, 0) + " % of the evidence; seen from " + point(by->from_W) + ")";
}

}  // namespace

AlikePlaces shown_alike(const BuildingMap& map, bool compass) {
  if (!compass) return map.alike;
  AlikePlaces shown;
  for (const Alike& one : map.alike.motions)
    if (one.compass) shown.motions.push_back(one);
  return shown;
}

std::string motion_text(const Pose& transform) {
  constexpr double least_deg = 0.5, least_m = 0.05;
  const double yaw = transform.yaw();
  const double turned = yaw / rad_per_deg, up = transform.t.z();
  const std::string higher =
      std::abs(up) < least_m ? "" : ", " + svg::number(std::abs(up), 1) + (up > 0.0 ? " m higher" : " m lower");
  if (std::abs(turned) < least_deg) {
    std::string text = "moved by ";
    bool any = false;
    for (const int axis : {0, 1})
      if (std::abs(transform.t[axis]) >= least_m) {
        text += std::string(any ? " and " : "") + svg::number(std::abs(transform.t[axis]), 1) + " m along " +
                (transform.t[axis] < 0.0 ? "-" : "") + "xy"[axis];
        any = true;
      }
    return any ? text + higher : higher.empty() ? "not moved" : higher.substr(2);
  }
  Eigen::Matrix2d away = Eigen::Matrix2d::Identity();
  away -= Eigen::Rotation2Dd(yaw).toRotationMatrix();
  const Eigen::Vector2d centre = away.inverse() * transform.t.head<2>();
  return "turned by " + svg::number(std::abs(turned), 0) + "° about " + point(centre) + higher;
}

std::string list_alike(const RunBuilding& building, const AlikePlaces& places) {
  const std::vector<Alike>& alike = places.motions;
  if (alike.empty()) return "<p class=\"facts\">No two places look alike.</p>";
  const bim::Building& plan = building.as_planned();
  std::string out =
      "<h2>What looks alike, and what distinguishes it</h2><div class=\"scroll\"><table class=\"stacked\" "
      "aria-label=\"what looks alike\">"
      "<tr class=\"heads\"><th></th><th>the plan, moved onto itself</th><th>rooms</th><th class=\"num\">places</th>"
      "<th>what distinguishes them</th></tr>";
  for (std::size_t i = 0; i < alike.size(); ++i) {
    const Alike& one = alike[i];
    out += "<tr><td>" + std::to_string(i + 1) + "</td><td data-head=\"motion\">" +
           svg::escape(motion_text(one.transform)) + "</td><td data-head=\"rooms\">" +
           svg::escape(rooms_text(plan, one.rooms)) + "</td><td class=\"num\" data-head=\"places\">" +
           std::to_string(one.places) + "</td><td class=\"plain\">" + svg::escape(distinction_text(one.distinguished)) +
           "</td></tr>";
  }
  out += "</table></div>";
  if (places.others == 0) return out;
  return out + "<p class=\"facts\">And " + (places.others == most_others ? "at least " : "") +
         std::to_string(places.others) + " more, with no more places each.</p>";
}

std::string draw_deciding(const RunBuilding& building, const AlikePlaces& places, int storey) {
  const std::vector<Alike>& alike = places.motions;
  std::string out;
  std::set<std::string> drawn;
  for (std::size_t i = 0; i < alike.size(); ++i) {
    const auto& by = alike[i].distinguished;
    if (!by || !drawn.insert(by->element).second) continue;
    const ElementOutline outline = outline_in(by->missing ? building.as_planned() : building.as_built(), by->element);
    if (outline.storey != storey || outline.polygon_W.empty()) continue;
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& p : outline.polygon_W) middle += p / static_cast<double>(outline.polygon_W.size());
    std::string numbers;
    for (std::size_t k = i; k < alike.size(); ++k)
      if (alike[k].distinguished && alike[k].distinguished->element == by->element)
        numbers += (numbers.empty() ? "" : ", ") + std::to_string(k + 1);
    out += svg::polygon(outline.polygon_W, "class=\"deciding\"", by->element + " decides " + numbers) +
           svg::text(middle + Eigen::Vector2d(0.1, 0.1), numbers, "class=\"number\"");
  }
  return out;
}

}  // namespace plumbline::scenarios
