// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/storeys_out_of_reach.h"

#include <algorithm>

#include "bim/model/building.h"

namespace plumbline::scenarios {

std::string stairs_at_fault(const sim::MultiStoreyPlanner& space) {
  const bim::Building& building = space.building();
  std::string list;
  for (const sim::StairWay& way : space.stairs())
    if (!way.fault.empty()) list += (list.empty() ? "" : ", ") + ("stair '" + way.id + "' " + way.fault);
  if (!list.empty()) return list;
  if (!building.stairs.empty()) return "no stair that can be walked to leads there";
  const bool ramp = std::any_of(building.obstacles.begin(), building.obstacles.end(),
                                [](const bim::Obstacle& obstacle) { return obstacle.kind == "ramp"; });
  return ramp ? "the building has ramps and no stairs, and no walk takes a ramp from storey to storey"
              : "the building has no stairs";
}

std::vector<std::string> storeys_out_of_reach(const sim::MultiStoreyPlanner& space, const sim::FloorPoint& at) {
  const bim::Building& building = space.building();
  const std::vector<int> reached = space.reachable_storeys(at);
  std::vector<std::string> out;
  for (int i = 0; i < static_cast<int>(building.storeys.size()); ++i) {
    const bim::Storey& storey = building.storeys[static_cast<std::size_t>(i)];
    if (std::binary_search(reached.begin(), reached.end(), i) || storey.kind != bim::StoreyKind::habitable) continue;
    const auto rooms = std::count_if(building.rooms.begin(), building.rooms.end(),
                                     [&](const bim::Room& candidate) { return candidate.storey == i; });
    out.push_back((storey.name.empty() ? storey.id : storey.name) + " (" + std::to_string(rooms) +
                  (rooms == 1 ? " room): " : " rooms): ") + stairs_at_fault(space));
  }
  return out;
}

}  // namespace plumbline::scenarios
