// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/outlier_cause.h"

#include <cmath>
#include <span>

namespace plumbline::slam {

namespace {

OutlierCause unplanned_at(const Eigen::Vector2d& p_I, const HypothesisComparisonConfig& config) {
  const Eigen::Vector2d cell = (p_I / config.clutter_cell_m).array().floor();
  return {OutlierCause::Kind::unplanned, static_cast<int>(cell.x()), static_cast<int>(cell.y())};
}

/// What lies behind the face of an element that a beam passes.
struct BehindFace {
  bool passes_element = true;      ///< the beam ends beyond the element's far side
  bool ends_at_next_face = false;  ///< the element is missing, and that explains where the beam ends
};
BehindFace behind_face(const Structure& structure, const PlanRay& ray, double range, double passed_m, int element,
                       const HypothesisComparisonConfig& config) {
  constexpr double past_m = 0.02;  // of the face that is passed, whose far side is passed, too
  const double tolerance = 3.0 * config.sigma_m;
  BehindFace behind;
  double at_m = passed_m + past_m;
  for (int face = 0; face < 3 && at_m < range + tolerance; ++face) {
    const Eigen::Vector2d from = ray.origin + at_m * ray.direction;
    const SensorRay rest{ray.direction, ray.slope};
    StructureHit hit;
    structure.cast({from.x(), from.y(), ray.z + at_m * ray.slope}, std::span(&rest, 1), cast_beyond_m + range,
                   std::span(&hit, 1));
    if (hit.element < 0) break;
    if (face == 0 && hit.element == element) behind.passes_element = at_m + hit.distance + tolerance < range;
    behind.ends_at_next_face = std::abs(at_m + hit.distance - range) < tolerance;
    if (behind.ends_at_next_face) break;
    at_m += hit.distance + past_m;
  }
  return behind;
}

}  // namespace

ExplainedOutlier explain_outlier(const Structure& structure, const PlanRay& ray, double range,
                                 const PredictedBlock& predicted, std::size_t lane,
                                 const HypothesisComparisonConfig& config) {
  using Kind = OutlierCause::Kind;
  const OutlierCause at_end = unplanned_at(ray.origin + range * ray.direction, config);
  const int element = predicted.element[lane];
  const double expected = predicted.expected[lane];
  if (element < 0) return {at_end, {}};
  if (expected >= range) return {{Kind::in_front_of_face, element, predicted.side[lane]}, {}};
  if (structure.is_railing(element)) return {{Kind::between_bars, element}, {}};
  const BehindFace behind = behind_face(structure, ray, range, expected, element, config);
  ExplainedOutlier outlier{{Kind::not_built, element}, {}, behind.passes_element && structure.is_wall(element)};
  if (!behind.ends_at_next_face) outlier.object = at_end;
  return outlier;
}

}  // namespace plumbline::slam
