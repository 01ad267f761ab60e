// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bim/config/tree.h"
#include "bim/formats/ifc/read/ifc.h"

namespace plumbline::bim {

/// The building in an IFC file.
inline Building read_ifc(const std::string& path) { return read_ifc_text(read_text_file(path), path); }

}  // namespace plumbline::bim
