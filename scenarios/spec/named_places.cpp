// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/named_places.h"

#include <algorithm>
#include <vector>

#include "bim/config/tree.h"
#include "bim/errors.h"

namespace plumbline::scenarios {

namespace {

std::string unknown(const std::string& kind, const std::string& name, const std::vector<std::string>& known) {
  const std::string close = did_you_mean(name, known);
  if (!close.empty()) return "unknown " + kind + " '" + name + "'; did you mean '" + close + "'?";
  std::string message = "unknown " + kind + " '" + name + "'; the building has:";
  for (const std::string& other : known)
    message += other.find(' ') == std::string::npos ? " " + other : " '" + other + "'";
  return message;
}

/// The first of this id among those that count, or else the only one of this name; -1 where there is none.
template <class Place, class Counts>
int index_of_named(const std::vector<Place>& places, const std::string& name, const std::string& kind, const Mark& mark,
                   Counts&& counts) {
  int found = -1, named = 0;
  std::string ids;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!counts(places[i])) continue;
    if (places[i].id == name) return static_cast<int>(i);
    if (places[i].name != name) continue;
    if (named++ == 0) found = static_cast<int>(i);
    ids += " " + places[i].id;
  }
  if (named > 1)
    throw InputError(mark, "'" + name + "' is the name of several " + kind + "; name one of them by its id:" + ids);
  return found;
}

/// How the rooms that count can be named: by their names, and by their ids where these do not tell them apart.
template <class Counts>
std::vector<std::string> names_of(const std::vector<bim::Room>& rooms, Counts&& counts) {
  std::vector<std::string> known;
  for (const bim::Room& room : rooms) {
    if (!counts(room)) continue;
    const auto same =
        std::count_if(rooms.begin(), rooms.end(), [&](const bim::Room& r) { return r.name == room.name; });
    known.push_back(room.name.empty() || same > 1 ? room.id : room.name);
  }
  return known;
}

}  // namespace

int find_storey(const bim::Building& building, const std::string& name, const Mark& mark) {
  const int found = index_of_named(building.storeys, name, "storeys", mark, [](const bim::Storey&) { return true; });
  if (found >= 0) return found;
  std::vector<std::string> known;
  for (const bim::Storey& storey : building.storeys) known.push_back(storey.name.empty() ? storey.id : storey.name);
  throw InputError(mark, unknown("storey", name, known));
}

int find_room(const bim::Building& building, const std::string& name, const Mark& mark) {
  if (building.rooms.empty())
    throw InputError(mark, "there is no room '" + name + "': no rooms are known in this building; " +
                               "give a start by {at: [x, y]} and the route {rooms: all}");
  const int found = index_of_named(building.rooms, name, "rooms", mark, [](const bim::Room&) { return true; });
  if (found >= 0) return found;
  throw InputError(mark, unknown("room", name, names_of(building.rooms, [](const bim::Room&) { return true; })));
}

int find_room_on(const bim::Building& building, int storey, const std::string& name, const Mark& mark) {
  const auto counts = [&](const bim::Room& room) { return room.storey == storey; };
  const int found = index_of_named(building.rooms, name, "rooms", mark, counts);
  if (found >= 0) return found;
  const std::string close = did_you_mean(name, names_of(building.rooms, counts));
  throw InputError(mark, "no room '" + name + "' on the storey of the start" +
                             (close.empty() ? "" : "; did you mean '" + close + "'?"));
}

}  // namespace plumbline::scenarios
