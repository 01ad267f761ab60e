// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "bim/model/building.h"

namespace plumbline::bim {

enum class BooleanOperation { difference, intersection };

/// What is done to a solid, and with which other closed one.
struct BooleanStep {
  BooleanOperation operation = BooleanOperation::difference;
  Solid other;
};

/// A solid, the union of its shells, after all steps in their order, in exact arithmetic from beginning to end (Nef
/// polyhedra [hachenberger2007]); only the result is rounded. It takes what corefinement refuses: faces in one plane,
/// solids that touch in edges or vertices, and results that do, whose touching parts are given vertices of their own.
/// Costs some milliseconds a step. Nullopt when an operand is not closed, runs through itself or has too many
/// triangles. Canonicalise the result.
[[nodiscard]] std::optional<Solid> exact_boolean(const Solid& body, std::span<const BooleanStep> steps, double grid_m);

/// The triangles with vertices doubled where more than two of them meet in an edge, or more than one fan in a vertex,
/// so that what touches itself closes: at each such edge those triangles belong together that bound the same material.
[[nodiscard]] Solid touching_parts_separated(const Solid& soup);

}  // namespace plumbline::bim
