// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bim/formats/plan_yaml/plan_file.h"
#include "bim/furniture/furnish.h"

namespace plumbline::bim {

/// The piece as an entry of a plan, on the storey of that id.
[[nodiscard]] PlanClutterEntry clutter_entry(const FurniturePiece& piece, const std::string& storey);

/// Adds furniture to the clutter of a plan that follows the rules of plan files; what was added. A storey
/// that copies another has its furniture, which is placed to suit both. What deviates as built is in the way too.
/// Throws InputError where the plan cannot be built or would hold too many entries.
std::vector<FurniturePiece> furnish_plan(PlanFile& plan, const FurnishOptions& options);

}  // namespace plumbline::bim
