// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "bim/model/building.h"

class BuildingModel;

namespace plumbline::bim {

/// What the file says about light, by material name: IfcMaterialProperties with any of Reflectivity, Transmission and
/// Specular, shares from 0 to 1, the others as a Material has them by default. Shares beyond that are left out.
[[nodiscard]] std::map<std::string, Material> read_optics(const BuildingModel& model);

}  // namespace plumbline::bim
