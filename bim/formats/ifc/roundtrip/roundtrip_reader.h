// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "bim/model/building.h"

namespace plumbline::bim {

/// Reads what write_ifc() wrote, exactly: reference lines and layers, bodies, footprints, relations, and the property
/// sets named Plumbline_... for what IFC cannot express. Nothing is rounded, inferred or left out. The text has
/// passed check_step_text(). Throws InputError with the line of an entity that is not as it was written.
[[nodiscard]] Building read_roundtrip(std::string_view text, const std::string& file);

}  // namespace plumbline::bim
