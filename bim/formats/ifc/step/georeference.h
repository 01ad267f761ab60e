// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>

#include "bim/formats/ifc/step/step_model.h"

namespace plumbline::bim {

/// How far coordinates may be from the origin.
struct GeoreferenceConfig {
  double furthest_m = 1e8;  ///< further out than any map grid, with the number of its zone before the easting
  double largest_m = 1e4;   ///< a body of this size is no building's
  double local_m = 5e3;     ///< a model whose middle is further out is moved: map coordinates
};

/// False where a coordinate is not a number or out of reach, or a body is too large.
[[nodiscard]] bool within_reach(const StepProduct& product, const GeoreferenceConfig& config = {});

/// Whether every coordinate of a product's place, axis and body is a number.
[[nodiscard]] bool is_finite(const StepProduct& product);

/// Extents of what walls, floors and spaces hold, m; those of nothing are negative.
[[nodiscard]] Eigen::Vector3d extent_of_building(const StepModel& model);

/// Moves a model that stands far from the origin (in map coordinates) so that the median of its walls comes near it, by
/// whole metres; without walls that of slabs, spaces and columns, and without these that of all bodies. The move, or
/// nullopt where none was needed.
[[nodiscard]] std::optional<Eigen::Vector3d> move_to_origin(StepModel& model, const GeoreferenceConfig& config = {});

}  // namespace plumbline::bim
