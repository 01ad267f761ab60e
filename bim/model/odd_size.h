// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bim/model/building.h"

namespace plumbline::bim {

/// "the building is 0.012 m long; is the unit right?" of a building smaller than a room or larger than a town, empty of
/// all others.
[[nodiscard]] std::string odd_size(const Building& building);

}  // namespace plumbline::bim
