// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bim/errors.h"
#include "bim/model/building.h"

namespace plumbline::scenarios {

/// Index of the storey of this id, or else of this name. Throws InputError at the mark where there is none, with the
/// names there are, or where several have the name, with their ids.
[[nodiscard]] int find_storey(const bim::Building& building, const std::string& name, const Mark& mark);

/// The same of a room.
[[nodiscard]] int find_room(const bim::Building& building, const std::string& name, const Mark& mark);

/// The same of a room on a storey, that of the start.
[[nodiscard]] int find_room_on(const bim::Building& building, int storey, const std::string& name, const Mark& mark);

}  // namespace plumbline::scenarios
