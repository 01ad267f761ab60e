// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bim/config/schema.h"

namespace plumbline::scenarios {

/// Valid sweeps that together have a value for every key.
[[nodiscard]] const std::vector<std::string>& sweep_examples();
/// Every key of a sweep file.
[[nodiscard]] std::vector<SchemaSection> sweep_schema();
/// The page that documents sweep files, in Markdown: docs/reference/sweep.md.
[[nodiscard]] std::string sweep_page();

}  // namespace plumbline::scenarios
