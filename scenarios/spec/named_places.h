// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bim/errors.h"
#include "bim/model/building.h"

namespace plumbline::scenarios {

/// Index of the storey of this id or name. Throws InputError at the mark, with the names there are.
[[nodiscard]] int find_storey(const bim::Building& building, const std::string& name, const Mark& mark);

/// The same of a room.
[[nodiscard]] int find_room(const bim::Building& building, const std::string& name, const Mark& mark);

}  // namespace plumbline::scenarios
