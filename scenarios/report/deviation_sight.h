// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "scenarios/localizability/localizability.h"
#include "scenarios/report/deviation_list.h"
#include "scenarios/spec/run_building.h"

namespace plumbline::scenarios {

/// Sets since when each deviation was in sight on a walk: the levelled scan of identifiability (8 x 360 beams, one for
/// each half metre) is cast in the building as planned and as built, and beams that end apart count for the outline
/// that they end at. Three of them in one scan are a sight of it.
void set_sights(const RunBuilding& building, const std::vector<TruthSample>& walk,
                std::vector<ReportDeviation>& deviations);

}  // namespace plumbline::scenarios
