// SPDX-License-Identifier: Apache-2.0
#include "scenarios/localizability/element_evidence.h"

#include <algorithm>

#include "scenarios/localizability/constants.h"

namespace plumbline::scenarios {

SeenPlace see(const RangeImager& imager, const ComparedScenes& scenes, const SensorPose& place) {
  SeenPlace out;
  out.seen = imager.cast(*scenes.as_built, place);
  out.own = scenes.as_built == scenes.as_planned ? out.seen : imager.cast(*scenes.as_planned, place);
  return out;
}

void ElementEvidence::add(const RangeImager& imager, const ComparedScenes& scenes, const SeenPlace& place,
                          const SensorPose& other) {
  const RangeImage& seen = place.seen;
  const RangeImage expected = imager.cast(*scenes.as_planned, other);
  const auto counted = [](double sum) { return std::max(sum, -localizability_constants.marginal_llr); };
  const double furniture_before = counted(by_furniture);
  for (std::size_t i = 0; i < seen.range_m.size(); ++i) {
    const bool loose =
        !scenes.loose.empty() && seen.element[i] >= 0 && scenes.loose[static_cast<std::size_t>(seen.element[i])] != 0;
    const double gain = beam_evidence(*scenes.as_planned, other, imager.directions()[i], seen.range_m[i],
                                      place.own.range_m[i], expected.range_m[i], loose);
    if (gain == 0.0) continue;
    (loose && gain < 0.0 ? by_furniture : llr) += gain;
    // Of two surfaces the nearer one is the feature: it stands before the other, or would.
    const bool missing = expected.range_m[i] < seen.range_m[i];
    by_element[{missing, missing ? expected.element[i] : seen.element[i]}] += gain;
  }
  llr += counted(by_furniture) - furniture_before;
}

std::optional<DecidingFeature> ElementEvidence::deciding() const {
  double sum = 0.0, most = 0.0;
  DecidingFeature feature;
  for (const auto& [key, gain] : by_element) {
    sum += std::max(gain, 0.0);
    if (gain <= most) continue;
    most = gain;
    feature = {key.first, key.second, 0.0};
  }
  if (feature.element < 0) return std::nullopt;
  feature.share = most / sum;
  return feature;
}

}  // namespace plumbline::scenarios
