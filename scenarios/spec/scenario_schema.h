// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bim/config/schema.h"

namespace plumbline::scenarios {

/// Valid scenarios that together have a value for every key.
[[nodiscard]] const std::vector<std::string>& scenario_examples();
/// Every key of a scenario file.
[[nodiscard]] std::vector<SchemaSection> scenario_schema();
/// The page that documents scenario files, in Markdown: docs/reference/scenario.md.
[[nodiscard]] std::string scenario_page();

}  // namespace plumbline::scenarios
