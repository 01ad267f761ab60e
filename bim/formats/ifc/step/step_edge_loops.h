// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace plumbline::bim {

/// The text with loops of edges, of which IFC++ makes nothing, as polygons: straight edges, and arcs of circles and
/// ellipses with a corner every 10 degrees. A face between two arcs and two straight lines, as of a cylinder or cone,
/// becomes a row of facets. Loops with other edges stay. The text has gone through with_plain_curves().
[[nodiscard]] std::string with_plain_loops(const std::string& text, const std::string& file);

}  // namespace plumbline::bim
