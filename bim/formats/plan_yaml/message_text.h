// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <string>

#include "bim/config/tree.h"

namespace plumbline::bim {

/// An id or a length as messages about plans write it. The length is in m and is rounded to a micrometre.
[[nodiscard]] inline std::string in_quotes(const std::string& text) { return "'" + text + "'"; }
[[nodiscard]] inline std::string metres(double length) { return format_number(std::round(length * 1e6) / 1e6) + " m"; }

}  // namespace plumbline::bim
