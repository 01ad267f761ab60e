// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "bim/formats/ifc/step/step_entities.h"

namespace plumbline::bim {

/// A body between outlines with as many corners, from each to the next, in the file's units. Faces between them look
/// outward. Bodies of more corners are not made.
struct RingBody {
  static constexpr std::size_t most_corners = 100'000;
  std::vector<std::vector<Eigen::Vector3d>> rings;
  bool closed = false;  ///< the last leads to the first; otherwise both ends have a face
};

/// What an IfcRevolvedAreaSolidTapered is [iso2018]: its profile turns into its end profile on the way. `radian` of the
/// file's unit of angle. Nullopt where either is bent or they differ in corners.
[[nodiscard]] std::optional<RingBody> tapered_revolution(const StepEntities& entities, const StepValue& attributes,
                                                         double radian);

/// What an IfcSurfaceCurveSweptAreaSolid on a plane is along straight lines [iso2018]: its profile's x axis along the
/// plane's normal, mitred where the lines bend. Nullopt for other surfaces, curves that are not straight or leave the
/// plane, and bent profiles.
[[nodiscard]] std::optional<RingBody> sweep_on_plane(const StepEntities& entities, const StepValue& attributes);

}  // namespace plumbline::bim
