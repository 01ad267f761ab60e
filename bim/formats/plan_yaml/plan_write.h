// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "bim/formats/plan_yaml/plan_file.h"

namespace plumbline::bim {

/// Plan YAML, an element a line, under comment lines; what is empty is left out, numbers are the shortest that read
/// back equal.
[[nodiscard]] std::string write_plan(const PlanFile& plan, std::string_view comment = {});

}  // namespace plumbline::bim
