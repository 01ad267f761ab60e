// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bim/config/schema.h"

namespace plumbline::bim {

/// A sound plan with a value for every key there is.
[[nodiscard]] std::string_view plan_example();
/// Every key of a plan file.
[[nodiscard]] std::vector<SchemaSection> plan_schema();
/// The page that documents plan files, Markdown; bim/PLAN.md is a copy of it.
[[nodiscard]] std::string plan_page();

}  // namespace plumbline::bim
