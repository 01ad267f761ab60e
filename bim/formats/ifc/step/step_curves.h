// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace plumbline::bim {

/// The text with curves that IFC++ cannot evaluate as polylines: indexed curves with lines and arcs, trimmed lines and
/// ellipses, arcs of circles trimmed by points, and splines. Arcs get a corner every 10 degrees. Points come behind all
/// other entities.
[[nodiscard]] std::string with_plain_curves(const std::string& text, const std::string& file);

}  // namespace plumbline::bim
