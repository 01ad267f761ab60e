// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/named_places.h"

#include <vector>

#include "bim/config/tree.h"
#include "bim/errors.h"

namespace plumbline::scenarios {

namespace {

std::string unknown(const std::string& kind, const std::string& name, const std::vector<std::string>& known) {
  const std::string close = did_you_mean(name, known);
  if (!close.empty()) return "unknown " + kind + " '" + name + "'; did you mean '" + close + "'?";
  std::string message = "unknown " + kind + " '" + name + "'; the building has:";
  for (const std::string& other : known) message += " " + other;
  return message;
}

}  // namespace

int find_storey(const bim::Building& building, const std::string& name, const Mark& mark) {
  std::vector<std::string> known;
  for (std::size_t i = 0; i < building.storeys.size(); ++i) {
    if (building.storeys[i].id == name || building.storeys[i].name == name) return static_cast<int>(i);
    known.push_back(building.storeys[i].name.empty() ? building.storeys[i].id : building.storeys[i].name);
  }
  throw InputError(mark, unknown("storey", name, known));
}

int find_room(const bim::Building& building, const std::string& name, const Mark& mark) {
  if (building.rooms.empty())
    throw InputError(mark, "there is no room '" + name + "': no rooms are known in this building; " +
                               "give a start by {at: [x, y]} and the route {rooms: all}");
  std::vector<std::string> known;
  for (std::size_t i = 0; i < building.rooms.size(); ++i) {
    if (building.rooms[i].id == name || building.rooms[i].name == name) return static_cast<int>(i);
    known.push_back(building.rooms[i].id);
  }
  throw InputError(mark, unknown("room", name, known));
}

}  // namespace plumbline::scenarios
