// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bim/config/tree.h"
#include "scenarios/shrink/shrink.h"

namespace plumbline::scenarios {

/// shrink.json.
[[nodiscard]] Tree to_results(const Shrunk& shrunk);
/// What fails, how much smaller it became, which ingredients it needs; lines.
[[nodiscard]] std::string shrink_text(const Shrunk& shrunk);

}  // namespace plumbline::scenarios
