// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "bim/formats/plan_yaml/stair_builder.h"
#include "bim/model/building.h"

namespace plumbline::bim {

/// Cuts every slab that leaves less than the head room over a step or landing of the stair; a slab that falls apart
/// becomes several.
void cut_stairwell(const Stair& stair, Building& building, const StairBuilderConfig& config = {});

/// Room of the stair's storey before its first step and beyond its last, -1 where there is none.
void find_stair_rooms(const Building& building, Stair& stair, const StairBuilderConfig& config = {});

/// Why a stair whose stairwell is cut cannot be walked: no floor before its first or beyond its last step, a wall or
/// column in its way. Nothing when it can be walked.
[[nodiscard]] std::optional<std::string> stair_fault(const Building& building, const Stair& stair,
                                                     const StairBuilderConfig& config = {});

}  // namespace plumbline::bim
