// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/plan_yaml/plan_stairs.h"

#include <algorithm>
#include <utility>

#include "bim/errors.h"
#include "bim/formats/plan_yaml/stairwell.h"
#include "bim/model/materials.h"

namespace plumbline::bim {

namespace {

/// Foot and head of an entry's stair and of its repetitions in copies of its lower storey.
std::vector<std::pair<int, int>> spans(const PlanFile& plan, const PlanStairEntry& entry, const Building& building) {
  const int from = find_entry(plan.storeys, entry.from), to = find_entry(plan.storeys, entry.to);
  const std::vector<int> order = storeys_upwards(building);
  const auto rank = [&](int storey) { return std::find(order.begin(), order.end(), storey) - order.begin(); };
  const auto up = rank(to) - rank(from);
  std::vector<std::pair<int, int>> found = {{from, to}};
  for (std::size_t i = 0; i < plan.storeys.size(); ++i) {
    if (plan.storeys[i].copy_of != entry.from) continue;
    const auto head = rank(static_cast<int>(i)) + up;
    if (head < static_cast<std::ptrdiff_t>(order.size()))
      found.emplace_back(static_cast<int>(i), order[static_cast<std::size_t>(head)]);
  }
  return found;
}

Stair built(const PlanFile& plan, const PlanStairEntry& entry, int from, int to, const Building& building,
            const Mark& mark) {
  const Storey &lower = building.storeys[static_cast<std::size_t>(from)],
               &upper = building.storeys[static_cast<std::size_t>(to)];
  const bool copied = !plan.storeys[static_cast<std::size_t>(from)].copy_of.empty() && lower.id != entry.from;
  const std::string id = copied ? lower.id + "/" + entry.id : entry.id;
  const double height_m = upper.elevation_m - lower.elevation_m;
  if (const auto fault = step_fault(entry, height_m))
    throw InputError(mark, "stair '" + id + "' from '" + lower.id + "' to '" + upper.id + "' " + *fault);
  Stair stair = build_stair(entry, lower.elevation_m, height_m);
  stair.id = id;
  stair.name = id;
  stair.from = from;
  stair.to = to;
  return stair;
}

}  // namespace

void add_stairs(const PlanFile& plan, const Tree& tree, Building& building) {
  std::vector<std::size_t> entries;  // of each stair
  for (std::size_t i = 0; i < plan.stairs.size(); ++i) {
    use_material(building, plan.stairs[i].material);
    const Mark& mark = tree.find("stairs")->as_list().at(i).mark;
    for (const auto& [from, to] : spans(plan, plan.stairs[i], building)) {
      building.stairs.push_back(built(plan, plan.stairs[i], from, to, building, mark));
      entries.push_back(i);
      cut_stairwell(building.stairs.back(), building);
    }
  }
  for (std::size_t i = 0; i < entries.size(); ++i) {
    Stair& stair = building.stairs[i];
    find_stair_rooms(building, stair);
    if (const auto fault = stair_fault(building, stair))
      throw InputError(tree.find("stairs")->as_list().at(entries[i]).mark,
                       "stair '" + stair.id + "' cannot be walked: " + *fault);
  }
}

}  // namespace plumbline::bim
