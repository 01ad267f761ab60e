// SPDX-License-Identifier: Apache-2.0
#include "scenarios/score/identifiability.h"

#include <algorithm>
#include <cmath>

#include "bim/plan/plan.h"
#include "scenarios/localizability/floor.h"
#include "scenarios/localizability/localizability.h"
#include "scenarios/metrics/storey.h"
#include "sim/world.h"

namespace plumbline::scenarios::score {

namespace {

/// Height of the levelled sensor: over the floor of a storey while the robot walks on one, its own on a stair.
double sensor_z_W(const bim::Plan& plan, const Pose& X_WR) {
  constexpr double on_floor_m = 0.15;  // the base of a walking robot stays this close to its height
  const auto storey = static_cast<std::size_t>(storey_of_base(plan.storeys, X_WR.t.z()));
  const double floor = plan.storeys[storey].elevation_m;
  const double under = X_WR.t.z() - base_height_m();
  return (std::abs(under - floor) < on_floor_m ? floor : under) + sim::World::calibration().sensor_height_m;
}

std::vector<PlacesLeft> places_left(const RunIdentifiability& run) {
  std::vector<PlacesLeft> places;
  for (const IdentifyStep& step : run.steps) {
    const auto weak = std::count_if(step.alive.begin(), step.alive.end(),
                                    [](const Twin& twin) { return twin.llr >= identify_constants.weak_llr; });
    const PlacesLeft left{step.t_s, step.distance_m, static_cast<int>(step.alive.size()), static_cast<int>(weak)};
    if (places.empty() || places.back().twins != left.twins || places.back().weak != left.weak) places.push_back(left);
  }
  return places;
}

}  // namespace

std::optional<Identifiability> identifiability_of(const RunFiles& files, const Truth& truth) {
  if (truth.scans.empty() || files.truth_W.empty()) return std::nullopt;
  const bim::Building& as_planned = files.site.as_planned;
  const SeenBuilding planned = seen_building(as_planned);
  std::optional<SeenBuilding> built;
  if (!files.site.changes.empty()) built.emplace(seen_building(files.site.as_built));
  const bim::Plan plan = bim::make_plan(as_planned);
  const auto start = static_cast<std::size_t>(storey_of_base(plan.storeys, files.truth_W.front().X_FR.t.z()));

  IdentifyInput input;
  input.as_planned = &planned.scene;
  input.as_built = built ? &built->scene : &planned.scene;
  input.yaw_known = files.scenario.prior.yaw == Knowledge::known;
  for (std::size_t i = 0; i < as_planned.storeys.size(); ++i)
    if (i == start || files.scenario.prior.storey == Knowledge::unknown)
      if (const IdentifyStorey area = search_area(as_planned, i); !area.empty()) input.storeys.push_back(area);
  if (input.storeys.empty()) return std::nullopt;  // a mesh

  std::vector<TruthSample> samples;
  for (const slam::Nanoseconds t : truth.scans)
    samples.push_back({slam::seconds(t - truth.scans.front()), truth.at(t), sensor_z_W(plan, truth.at(t))});
  const RunIdentifiability run = identify_run(input, samples);

  Identifiability result;
  result.identifiable = run.identifiable;
  result.at_s = run.identifiable_at_s;
  result.at_m = run.identifiable_at_m;
  result.tellable_from_s = run.tellable_from_s();
  for (const Twin& twin : run.steps.front().alive) result.twins_at_start.push_back(twin.twin);
  result.places = places_left(run);
  if (run.decided_by) {
    const SeenBuilding& seen = run.decided_by->missing || !built ? planned : *built;
    result.decided_by = DecidingElement{seen.elements.at(static_cast<std::size_t>(run.decided_by->element)),
                                        run.decided_by->missing, run.decided_by->share};
  }
  result.others_W = run.ambiguity_set(samples.back().t_s, samples.back().X_WR);
  return result;
}

}  // namespace plumbline::scenarios::score
