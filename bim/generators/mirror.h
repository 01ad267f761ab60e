// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/model/building.h"

namespace plumbline::bim {

/// The mirror image of a building in the plane x = 0 of W: ids, heights and materials stay, and its name says so.
[[nodiscard]] Building mirrored(Building building);

}  // namespace plumbline::bim
