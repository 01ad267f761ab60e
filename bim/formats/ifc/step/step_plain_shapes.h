// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace plumbline::bim {

/// The text with shapes that IFC++ gets wrong as others that are the same: transformation operators with all their
/// axes, directions of extrusion of length 1, mirrored profiles as derived ones, I-shapes with unequal flanges as
/// outlines, and solids over composite profiles as unions.
[[nodiscard]] std::string with_plain_shapes(const std::string& text, const std::string& file);

}  // namespace plumbline::bim
