// SPDX-License-Identifier: Apache-2.0
#include "scenarios/localizability/localizability.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "scenarios/localizability/aliased_poses.h"

namespace plumbline::scenarios {

namespace {

SensorPose levelled(const Pose& X_WR, double z) { return {{X_WR.t.x(), X_WR.t.y(), z}, X_WR.yaw()}; }

/// An aliased pose with the evidence against it.
struct Followed {
  Pose transform;
  ElementEvidence evidence;
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
void compare(const ComparedScenes& scenes, const SensorPose& truth, std::vector<Followed>& followed) {
  const RangeImager imager;
  const SeenPlace place = see(imager, scenes, truth);
  for (Followed& one : followed) {
    const Pose X = one.transform * truth.pose();
    one.evidence.add(imager, scenes, place, {X.t, X.yaw()});
  }
}

/// Drops aliases that are ruled out. The first of those that are dropped last says what decided.
void drop(std::vector<Followed>& followed, RunIdentifiability& run) {
  const auto ruled_out = [](const Followed& one) { return one.evidence.llr > localizability_constants.drop_llr; };
  const auto first = std::find_if(followed.begin(), followed.end(), ruled_out);
  const std::optional<Followed> last = first == followed.end() ? std::nullopt : std::optional(*first);
  std::erase_if(followed, ruled_out);
  if (last && followed.empty()) run.decided_by = last->evidence.deciding();
}

void conclude(RunIdentifiability& run) {
  // Where nowhere was looked, that nothing was found says nothing.
  run.identifiable = run.places > 0 && !run.steps.empty() && run.steps.back().alive.empty();
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
  run.places = index.size();
  const AliasFinder finder(index, *input.as_planned, *input.as_built, input.loose, input.isometries);
  std::vector<Followed> followed;
  for (const auto& [walked, sample] : stations(truth)) {
    const SensorPose place = levelled(sample->X_WR, sample->sensor_z_W);
    if (run.steps.empty())
      for (const FoundAlias& found : finder.find(finder.scan_at(place), {-1, input.yaw_known, true}))
        followed.push_back({found.place.pose() * place.pose().inverse(), {}});
    if (!followed.empty()) {
      compare({input.as_planned, input.as_built, input.loose}, place, followed);
      drop(followed, run);
    }
    LocalizabilityStep& step = run.steps.emplace_back(LocalizabilityStep{sample->t_s, walked, {}});
    for (const Followed& one : followed) step.alive.push_back({one.transform, one.evidence.llr});
  }
  conclude(run);
  return run;
}

}  // namespace plumbline::scenarios
