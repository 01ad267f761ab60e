// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bim/config/tree.h"
#include "bim/symmetry/symmetry.h"

namespace plumbline::scenarios {

/// `symmetry` of `inspect --json`: {storeys, copies, reflections, building, rooms}. An isometry is {angle_deg, t [x, y]
/// in m, about [x, y] where it turns, mirrored}: p' = R(angle) M p + t; with it grade (exact | near), iou, deviation_m
/// and the elements that deviate.
[[nodiscard]] Tree symmetry_json(const bim::Building& building, const bim::SymmetryReport& report);

/// The same for people, a line each.
[[nodiscard]] std::string symmetry_text(const bim::Building& building, const bim::SymmetryReport& report);

}  // namespace plumbline::scenarios
