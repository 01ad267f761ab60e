// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bim/config/tree.h"

namespace plumbline::scenarios {

/// What the walk covers, rooms out of reach and why, rooms left out, and warnings, as a card; from the block `walk` of
/// results.json, which may be null. Empty without one.
[[nodiscard]] std::string list_walk(const Tree* walk);

}  // namespace plumbline::scenarios
