// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bim/building/building.h"

namespace plumbline::bim {

/// Reads a building of any kind this version knows, told by its content: a plan (YAML whose first key is
/// `plan: 1`) or an IFC file.
/// Throws InputError when the file is missing, a directory, empty or of another kind.
[[nodiscard]] Building load_building(const std::string& path);

}  // namespace plumbline::bim
