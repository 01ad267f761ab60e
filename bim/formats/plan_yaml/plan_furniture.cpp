// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/plan_yaml/plan_furniture.h"

#include <vector>

#include "bim/errors.h"
#include "bim/formats/plan_yaml/plan_elements.h"
#include "bim/formats/plan_yaml/plan_write.h"
#include "bim/formats/plan_yaml/plan_yaml.h"

namespace plumbline::bim {

PlanClutterEntry clutter_entry(const FurniturePiece& piece, const std::string& storey) {
  PlanClutterEntry entry;
  entry.id = piece.id;
  entry.storey = storey;
  entry.shape = clutter_shape_of(piece.shape);
  entry.at = piece.at;
  entry.size = piece.size;
  entry.yaw_deg = piece.yaw_deg;
  entry.height_m = piece.height_m;
  return entry;
}

std::vector<FurniturePiece> furnish_plan(PlanFile& plan, const FurnishOptions& options) {
  const PlanWithDeviations both = read_plan_with_deviations(write_plan(plan), plan.name);
  FurnishSites sites;
  sites.as_built = &both.as_built.building;
  for (const PlanStoreyEntry& storey : plan.storeys)
    sites.repeats.push_back(storey.copy_of.empty() ? -1 : find_entry(plan.storeys, storey.copy_of));
  std::vector<FurniturePiece> pieces = furnish_pieces(both.as_planned, options, sites);
  if (plan.clutter.size() + pieces.size() > plan_entries_max)
    throw InputError({plan.name, 0, 0}, "the plan would hold more than " + std::to_string(plan_entries_max) +
                                            " pieces of clutter; lower the density");
  for (const FurniturePiece& piece : pieces)
    plan.clutter.push_back(clutter_entry(piece, plan.storeys[static_cast<std::size_t>(piece.storey)].id));
  return pieces;
}

}  // namespace plumbline::bim
