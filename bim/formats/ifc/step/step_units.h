// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "bim/formats/ifc/step/step_entities.h"

namespace plumbline::bim {

/// The unit of a kind, such as LENGTHUNIT, that the project assigns, in metres or radians: that of an IfcSIUnit with
/// its prefix, or so many times another as an IfcConversionBasedUnit says. Nullopt where the file assigns none or it
/// makes no sense.
[[nodiscard]] std::optional<double> assigned_unit(const StepEntities& entities, std::string_view kind);

}  // namespace plumbline::bim
