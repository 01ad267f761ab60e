// SPDX-License-Identifier: Apache-2.0
#include "scenarios/localizability/localizability.h"

#include <algorithm>
#include <map>
#include <utility>

#include "scenarios/localizability/aliased_poses.h"

namespace plumbline::scenarios {

namespace {

SensorPose levelled(const Pose& X_WR, double z) { return {{X_WR.t.x(), X_WR.t.y(), z}, X_WR.yaw()}; }

/// Evidence by element: of the planned mesh where missing, else of the one as built.
using Evidence = std::map<std::pair<bool, int>, double>;

/// An aliased pose with the evidence against it.
struct Followed {
  AliasedPose alias;
  Evidence evidence;
};

/// Poses at which a scan is compared: the first, then one per step_m walked.
std::vector<std::pair<double, const TruthSample*>> stations(const std::vector<TruthSample>& truth) {
  std::vector<std::pair<double, const TruthSample*>> out;
  double walked = 0.0;
  double last = -localizability_constants.step_m;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (i > 0) walked += (truth[i].X_WR.t - truth[i - 1].X_WR.t).head<2>().norm();
    if (walked - last < localizability_constants.step_m) continue;
    last = walked;
    out.emplace_back(walked, &truth[i]);
  }
  return out;
}

/// Adds the evidence of a scan at the true pose against each alias.
void compare(const LocalizabilityInput& input, const SensorPose& truth, std::vector<Followed>& followed) {
  const RangeImager imager;
  const RangeImage seen = imager.cast(*input.as_built, truth);
  const RangeImage own = input.as_built == input.as_planned ? seen : imager.cast(*input.as_planned, truth);
  for (Followed& one : followed) {
    const Pose X = one.alias.transform * truth.pose();
    const RangeImage expected = imager.cast(*input.as_planned, {X.t, X.yaw()});
    for (std::size_t i = 0; i < seen.range_m.size(); ++i) {
      const bool loose =
          !input.loose.empty() && seen.element[i] >= 0 && input.loose[static_cast<std::size_t>(seen.element[i])] != 0;
      const double gain = beam_evidence(*input.as_planned, {X.t, X.yaw()}, imager.directions()[i], seen.range_m[i],
                                        own.range_m[i], expected.range_m[i], loose);
      if (gain == 0.0) continue;
      one.alias.llr += gain;
      // Of two surfaces the nearer one is the feature: it stands before the other, or would.
      const bool missing = expected.range_m[i] < seen.range_m[i];
      one.evidence[{missing, missing ? expected.element[i] : seen.element[i]}] += gain;
    }
  }
}

/// Drops aliases that are ruled out. The first of those that are dropped last says what decided.
void drop(std::vector<Followed>& followed, RunIdentifiability& run) {
  std::optional<Followed> last;
  for (const Followed& one : followed)
    if (one.alias.llr > localizability_constants.drop_llr && !last) last = one;
  std::erase_if(followed, [](const Followed& one) { return one.alias.llr > localizability_constants.drop_llr; });
  if (!last || !followed.empty()) return;
  double sum = 0.0;
  DecidingFeature feature;
  double most = 0.0;
  for (const auto& [key, gain] : last->evidence) {
    sum += std::max(gain, 0.0);
    if (gain <= most) continue;
    most = gain;
    feature = {key.first, key.second, 0.0};
  }
  feature.share = sum > 0.0 ? most / sum : 0.0;
  if (feature.element >= 0) run.decided_by = feature;
}

void conclude(RunIdentifiability& run) {
  run.identifiable = !run.steps.empty() && run.steps.back().alive.empty();
  if (!run.identifiable) return;
  std::size_t first = run.steps.size() - 1;
  while (first > 0 && run.steps[first - 1].alive.empty()) --first;
  run.identifiable_at_s = run.steps[first].t_s;
  run.identifiable_at_m = run.steps[first].distance_m;
}

}  // namespace

std::vector<Pose> RunIdentifiability::ambiguity_set(double t_s, const Pose& X_WR) const {
  const LocalizabilityStep* now = nullptr;
  for (const auto& step : steps)
    if (step.t_s <= t_s) now = &step;
  std::vector<Pose> poses;
  if (now != nullptr)
    for (const AliasedPose& alias : now->alive) poses.push_back(alias.transform * X_WR);
  return poses;
}

std::optional<double> RunIdentifiability::marginal_from_s() const {
  std::optional<double> from;
  for (const auto& step : steps) {
    const bool strong = std::any_of(step.alive.begin(), step.alive.end(),
                                    [](const AliasedPose& t) { return t.llr < localizability_constants.marginal_llr; });
    if (strong)
      from.reset();
    else if (!from)
      from = step.t_s;
  }
  return from;
}

RunIdentifiability compute_localizability(const LocalizabilityInput& input, const std::vector<TruthSample>& truth) {
  RunIdentifiability run;
  const PlaceIndex index(*input.as_planned, input.storeys, localizability_constants.grid_m, input.threads);
  const AliasFinder finder(index, *input.as_planned, *input.as_built, input.loose);
  std::vector<Followed> followed;
  for (const auto& [walked, sample] : stations(truth)) {
    const SensorPose place = levelled(sample->X_WR, sample->sensor_z_W);
    if (run.steps.empty())
      for (const FoundAlias& found : finder.find(finder.scan_at(place), {-1, input.yaw_known}))
        followed.push_back({{found.place.pose() * place.pose().inverse(), 0.0}, {}});
    if (!followed.empty()) {
      compare(input, place, followed);
      drop(followed, run);
    }
    LocalizabilityStep& step = run.steps.emplace_back(LocalizabilityStep{sample->t_s, walked, {}});
    for (const Followed& one : followed) step.alive.push_back(one.alias);
  }
  conclude(run);
  return run;
}

}  // namespace plumbline::scenarios
