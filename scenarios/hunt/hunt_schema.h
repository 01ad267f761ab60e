// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bim/config/schema.h"

namespace plumbline::scenarios {

/// Valid hunts that together have a value for every key.
[[nodiscard]] const std::vector<std::string>& hunt_examples();
/// Every key of a hunt file.
[[nodiscard]] std::vector<SchemaSection> hunt_schema();
/// The page that documents hunt files, in Markdown: docs/reference/hunt.md.
[[nodiscard]] std::string hunt_page();

}  // namespace plumbline::scenarios
