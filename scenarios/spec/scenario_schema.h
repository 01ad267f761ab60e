// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bim/config/schema.h"

namespace plumbline::scenarios {

/// Sound scenarios that together have a value for every key there is.
[[nodiscard]] const std::vector<std::string>& scenario_examples();
/// Every key of a scenario file.
[[nodiscard]] std::vector<SchemaSection> scenario_schema();
/// The page that documents scenario files, Markdown; scenarios/SCENARIO.md is a copy of it.
[[nodiscard]] std::string scenario_page();

}  // namespace plumbline::scenarios
