// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bim/config/tree.h"
#include "bim/formats/plan_yaml/plan_deviation.h"
#include "bim/formats/plan_yaml/plan_entries.h"
#include "bim/formats/plan_yaml/plan_stair.h"
#include "bim/formats/plan_yaml/plan_symmetry.h"

namespace plumbline::bim {

/// What stands in a file of kind `plan: 1`, as written.
struct PlanFile {
  int plan = 1;
  std::string name;
  std::vector<PlanStoreyEntry> storeys;
  std::vector<PlanWallEntry> walls;
  std::vector<PlanOpeningEntry> openings;
  std::vector<PlanRoomEntry> rooms;
  std::vector<PlanColumnEntry> columns;
  std::vector<PlanStairEntry> stairs;
  std::vector<PlanClutterEntry> clutter;
  std::vector<PlanMaterialEntry> materials;
  std::vector<PlanDeviationEntry> deviations;
  std::optional<PlanSymmetryEntry> symmetry;

  template <class V>
  void visit(V& v) {
    v("plan", plan, plain_field("version of the format", {.min = 1, .max = 1, .required = true}));
    v("name", name, Field{.doc = "name of the building"});
    v("storeys", storeys, Field{.doc = "storeys, at least one", .required = true});
    v("walls", walls, Field{.doc = "walls, at least one", .required = true});
    v("openings", openings, Field{.doc = "doors, windows and voids in walls"});
    v("rooms", rooms, Field{.doc = "rooms of the plan, known to methods"});
    v("columns", columns, Field{.doc = "vertical blocks, part of the structure"});
    v("stairs", stairs, Field{.doc = "stairs, each from one storey to another"});
    v("clutter", clutter, Field{.doc = "planned furniture and other objects"});
    v("materials", materials, Field{.doc = "materials beside the presets"});
    v("deviations", deviations,
      Field{.doc = "differences of the building as built from the plan, applied in their order"});
    v("symmetry", symmetry, Field{.doc = "declared symmetry of the plan, as `generate` writes it"});
  }
};

/// Index of the entry with this id, -1 when there is none.
template <class Entry>
[[nodiscard]] int find_entry(const std::vector<Entry>& entries, std::string_view id) {
  for (std::size_t i = 0; i < entries.size(); ++i)
    if (entries[i].id == id) return static_cast<int>(i);
  return -1;
}

/// Height of a storey with its default resolved; `storey` must be in the file.
[[nodiscard]] double storey_height(const PlanFile& plan, const PlanStoreyEntry& storey);

/// InputError unless the id can be given: not empty, and without '/', which is kept for copies of storeys.
void check_plan_id(const std::string& id, const Mark& mark);
/// InputError unless the material is one of the building or a preset.
void check_material_id(const Building& building, const std::string& material, const Mark& mark);
/// The storeys and rooms that `symmetry` names are in the plan. Throws InputError.
void check_plan_symmetry(const PlanFile& plan, const Tree& tree);
/// Every rule that a single field cannot know (references, lengths, overlaps). Throws InputError at the offending
/// place of `tree`, which the file was read from.
void check_plan(const PlanFile& plan, const Tree& tree);
/// The entries of a file, checked. Throws InputError, also where the first key is not `plan`.
[[nodiscard]] PlanFile plan_entries(const Tree& tree);

}  // namespace plumbline::bim
