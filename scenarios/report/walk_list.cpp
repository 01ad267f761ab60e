// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/walk_list.h"

#include <utility>
#include <vector>

#include "scenarios/report/results.h"
#include "scenarios/report/svg.h"

namespace plumbline::scenarios {

namespace {

std::string sentence(const Tree& walk) {
  std::string text = "Planned: " + svg::number(number_of(&walk, "planned_m").value_or(0.0), 1) + " m";
  const std::string storey = text_of(walk, "storey");
  const Tree* rooms = walk.find("rooms");
  if (rooms == nullptr) return text + " on " + storey + "; no rooms are known there.";
  const auto count = [&](const char* key) { return svg::number(number_of(rooms, key).value_or(0.0), 0); };
  const auto elsewhere = number_of(rooms, "elsewhere");
  text += " through " + count("on_route") + " of the " + count("on_storey") + " rooms on " + storey;
  if (elsewhere) text += " and " + count("elsewhere") + (*elsewhere == 1.0 ? " room" : " rooms") + " of other storeys";
  return text + "; " + count("in_reach") + " on " + storey + " are in reach.";
}

/// Rooms with the same reason stand together, in the order of the first.
std::string out_of_reach(const Tree& rooms) {
  std::vector<std::pair<std::string, std::string>> groups;
  for (const Tree& room : rooms.as_list()) {
    const std::string why = text_of(room, "why"), name = text_of(room, "name");
    auto group = groups.begin();
    while (group != groups.end() && group->first != why) ++group;
    if (group == groups.end())
      groups.emplace_back(why, name);
    else
      group->second += ", " + name;
  }
  std::string out;
  for (const auto& [why, names] : groups) out += "<li><b>" + svg::escape(names) + "</b>: " + svg::escape(why) + "</li>";
  return out.empty() ? "" : "<p>Out of reach:</p><ul>" + out + "</ul>";
}

std::string left_out(const Tree& names) {
  std::string list;
  for (const Tree& name : names.as_list()) list += (list.empty() ? "" : ", ") + name.as_string();
  return list.empty() ? "" : "<p class=\"facts\">In reach and not on the route: " + svg::escape(list) + ".</p>";
}

}  // namespace

std::string list_walk(const Tree* walk) {
  if (walk == nullptr) return "";
  std::string out = "<section class=\"card\"><h2>The walk</h2>";
  for (const Tree& warning : walk->find("warnings")->as_list())
    out += "<p class=\"verdict bad\">" + svg::marked_up(warning.as_string()) + "</p>";
  out += "<p class=\"facts\">" + svg::escape(sentence(*walk)) + "</p>";
  return out + out_of_reach(*walk->find("out_of_reach")) + left_out(*walk->find("left_out")) + "</section>";
}

}  // namespace plumbline::scenarios
