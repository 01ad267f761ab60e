// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bim/model/building.h"

namespace plumbline::bim {

/// Dimensions that IFC needs and a building does not have.
struct IfcWriteConfig {
  double overhang_m = 0.01;  ///< of a plain opening beyond both faces of its wall, so that no faces coincide
  bool signature = true;     ///< false: read again as the file of another program
  double leaf_m = 0.04;      ///< thickness of the doors and windows drawn in openings; never above the wall's
};

/// The building as IFC4 text in metres: GlobalIds kept where an id is one and else made of the building's name,
/// the kind, the storey and the id. The same building gives the same bytes; read_ifc_text() gives back a building with
/// the same hash().
[[nodiscard]] std::string write_ifc(const Building& building, const IfcWriteConfig& config = {});

}  // namespace plumbline::bim
