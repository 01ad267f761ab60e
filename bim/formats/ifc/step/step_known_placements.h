// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace plumbline::bim {

/// The text with placements of IFC4's successors as IFC4 has them. Linear placements become local ones by their
/// Cartesian fallback, or without one grid placements that lead nowhere, so that what stands there is left out; grid
/// placements lose the placement they are relative to, which is that of their grid. Lines may move.
[[nodiscard]] std::string with_known_placements(const std::string& text, const std::string& file);

}  // namespace plumbline::bim
