// SPDX-License-Identifier: Apache-2.0
#include "bim/mesh/boolean.h"

#include <cmath>
#include <optional>
#include <utility>

#include "bim/mesh/corefine.h"
#include "bim/mesh/membrane.h"
#include "bim/mesh/shells.h"
#include "bim/mesh/solid.h"
#include "bim/mesh/surface_cut.h"

namespace plumbline::bim {
namespace {

Solid tidied(const Solid& solid, double grid_m) {
  return canonical(without_slivers(welded(solid, grid_m), grid_m), grid_m);
}

/// Nullopt when a step cannot be taken or its result does not close.
std::optional<Solid> corefined(Solid body, std::span<const BooleanStep> steps, double grid_m) {
  for (const BooleanStep& step : steps) {
    const std::optional<Solid> rest = step.operation == BooleanOperation::difference
                                          ? difference(body, step.other, grid_m)
                                          : intersection(body, step.other, grid_m);
    if (!rest) return std::nullopt;
    Solid next = tidied(*rest, grid_m);
    if (next.triangles.empty()) return next;
    if (!is_closed(next)) return std::nullopt;
    // What only touches the body would leave its outline on it.
    if (std::abs(volume(next) - volume(body)) > grid_m * grid_m) body = std::move(next);
  }
  return body;
}

/// By corefinement, where that gives up in exact arithmetic.
std::optional<Solid> taken(const Solid& body, const Solid& whole, std::span<const BooleanStep> steps, double grid_m) {
  std::optional<Solid> rest = corefined(shells_may_overlap(body, grid_m) ? whole : body, steps, grid_m);
  return rest ? rest : exact_boolean(whole, steps, grid_m);
}

std::vector<BooleanStep> widened(std::span<const BooleanStep> steps, double grid_m) {
  // Rounding moves a face by less than one step, so what should coincide lies less than two apart: before and after.
  const double by_m = 4.0 * grid_m;
  std::vector<BooleanStep> result(steps.begin(), steps.end());
  for (BooleanStep& step : result) step.other = canonical(widened(step.other, by_m), grid_m);
  return result;
}

/// Cuts that end on a face of the body may leave a skin without thickness, or a surface that meets itself in an edge
/// and so does not close; slightly wider ones do not.
std::optional<Solid> taken_cleanly(const Solid& body, const Solid& whole, std::span<const BooleanStep> steps,
                                   double grid_m) {
  std::optional<Solid> rest = taken(body, whole, steps, grid_m);
  if (rest && !has_membrane(*rest, grid_m)) return rest;
  std::optional<Solid> clean = taken(body, whole, widened(steps, grid_m), grid_m);
  return clean && (!rest || !has_membrane(*clean, grid_m)) ? clean : rest;
}

}  // namespace

BooleanResult boolean_steps(const Solid& body, std::span<const BooleanStep> steps, double grid_m) {
  BooleanResult result;
  std::vector<BooleanStep> usable;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    std::optional<Solid> closed = repaired(steps[i].other, grid_m);
    if (closed)
      usable.push_back({steps[i].operation, canonical(*closed, grid_m)});
    else
      result.failed.push_back(i);
  }
  std::optional<Solid> whole = repaired(body, grid_m);
  if (usable.empty()) {
    result.closed = whole.has_value();
    result.solid = whole ? std::move(*whole) : body;
    return result;
  }
  if (whole) {
    if (std::optional<Solid> rest = taken_cleanly(body, *whole, usable, grid_m)) {
      result.solid = std::move(*rest);
      return result;
    }
  }
  result.closed = false;
  result.solid = body;
  for (const BooleanStep& step : usable) result.solid = surface_cut(result.solid, step, grid_m);
  return result;
}

}  // namespace plumbline::bim
