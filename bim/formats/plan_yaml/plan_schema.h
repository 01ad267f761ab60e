// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bim/config/schema.h"

namespace plumbline::bim {

/// A valid plan with a value for every key.
[[nodiscard]] std::string_view plan_example();
/// Every key of a plan file.
[[nodiscard]] std::vector<SchemaSection> plan_schema();
/// The page that documents plan files, in Markdown: docs/reference/plan.md.
[[nodiscard]] std::string plan_page();

}  // namespace plumbline::bim
