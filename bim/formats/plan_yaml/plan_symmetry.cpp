// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/plan_yaml/plan_symmetry.h"

#include "bim/errors.h"
#include "bim/formats/plan_yaml/plan_file.h"

namespace plumbline::bim {

namespace {

/// Room of a plan, or of a storey that copies another ("first/kitchen").
bool is_room(const PlanFile& plan, const std::string& id) {
  if (find_entry(plan.rooms, id) >= 0) return true;
  const std::size_t slash = id.find('/');
  if (slash == std::string::npos) return false;
  const int storey = find_entry(plan.storeys, id.substr(0, slash));
  const int room = find_entry(plan.rooms, id.substr(slash + 1));
  return storey >= 0 && room >= 0 &&
         plan.storeys[static_cast<std::size_t>(storey)].copy_of == plan.rooms[static_cast<std::size_t>(room)].storey;
}

void check_storey(const PlanFile& plan, const std::string& id, const Mark& mark) {
  if (find_entry(plan.storeys, id) < 0)
    throw InputError(mark, "there is no storey '" + id + "'; name one that the plan lists");
}

void check_room(const PlanFile& plan, const std::string& id, const Mark& mark) {
  if (!is_room(plan, id)) throw InputError(mark, "there is no room '" + id + "'; name one that the plan lists");
}

}  // namespace

void check_plan_symmetry(const PlanFile& plan, const Tree& tree) {
  const Tree& symmetry = *tree.find("symmetry");
  const PlanSymmetryEntry& entry = *plan.symmetry;
  for (std::size_t i = 0; i < entry.group.size(); ++i) {
    const Mark mark = symmetry.find("group")->as_list().at(i).mark;
    if (entry.group[i].from.size() != entry.group[i].to.size())
      throw InputError(mark, "'from' and 'to' must name as many storeys as each other");
    for (const auto* storeys : {&entry.group[i].from, &entry.group[i].to})
      for (const std::string& storey : *storeys) check_storey(plan, storey, mark);
  }
  for (std::size_t i = 0; i < entry.rooms_alike.size(); ++i)
    for (const std::string& room : entry.rooms_alike[i])
      check_room(plan, room, symmetry.find("rooms_alike")->as_list().at(i).mark);
  if (!entry.feature) return;
  const Mark mark = symmetry.find("feature")->mark;
  check_storey(plan, entry.feature->storey, mark);
  if (!entry.feature->room.empty()) check_room(plan, entry.feature->room, mark);
  for (const std::string& room : entry.feature->visible_from) check_room(plan, room, mark);
}

}  // namespace plumbline::bim
