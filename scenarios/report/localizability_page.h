// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "scenarios/localizability/building_map.h"

namespace plumbline::scenarios {

/// One self-contained page with a map an answer, storey and condition.
[[nodiscard]] std::string localizability_page(const RunBuilding& building, const std::string& name,
                                              const BuildingMaps& maps);

}  // namespace plumbline::scenarios
