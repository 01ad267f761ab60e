// SPDX-License-Identifier: Apache-2.0
#include "scenarios/score/identifiability.h"

#include <algorithm>
#include <cmath>

#include "scenarios/localizability/floor.h"
#include "scenarios/localizability/localizability.h"
#include "scenarios/metrics/storey.h"

namespace plumbline::scenarios::score {

namespace {

constexpr double on_floor_m = 0.15;  ///< the base of a walking robot stays this close to its height

std::vector<AliasesLeft> places_left(const RunIdentifiability& run) {
  std::vector<AliasesLeft> places;
  for (const LocalizabilityStep& step : run.steps) {
    const auto marginal = std::count_if(step.alive.begin(), step.alive.end(), [](const AliasedPose& alias) {
      return alias.llr >= localizability_constants.marginal_llr;
    });
    const AliasesLeft left{step.t_s, step.distance_m, static_cast<int>(step.alive.size()), static_cast<int>(marginal)};
    if (places.empty() || places.back().aliases != left.aliases || places.back().marginal != left.marginal)
      places.push_back(left);
  }
  return places;
}

struct Question {
  std::vector<SearchArea> storeys;
  bool yaw_known = false;
  std::vector<TruthSample> samples;
};

/// Nullopt where the plan has no place to compare the run's with.
std::optional<IdentifiabilityAnswer> answer(const RunBuilding& building, PlanEvidence by, const Question& question) {
  const VisibleBuilding visible = visible_building(building, by);
  LocalizabilityInput input;
  input.as_planned = &visible.planned.scene;
  input.as_built = &visible.as_built().scene;
  input.loose = visible.loose;
  input.isometries = visible.isometries;
  input.storeys = question.storeys;
  input.yaw_known = question.yaw_known;
  const RunIdentifiability known = compute_localizability(input, question.samples);
  if (known.places == 0) return std::nullopt;
  IdentifiabilityAnswer result;
  result.identifiable = known.identifiable;
  result.at_s = known.identifiable_at_s;
  result.at_m = known.identifiable_at_m;
  result.marginal_from_s = known.marginal_from_s();
  for (const AliasedPose& alias : known.steps.front().alive) result.aliases_at_start.push_back(alias.transform);
  result.places = places_left(known);
  if (known.decided_by) {
    const VisibleScene& seen = known.decided_by->missing ? visible.planned : visible.as_built();
    result.decided_by = DecidingElement{seen.elements.at(static_cast<std::size_t>(known.decided_by->element)),
                                        known.decided_by->missing, known.decided_by->share};
  }
  result.others_W = known.ambiguity_set(question.samples.back().t_s, question.samples.back().X_WR);
  return result;
}

}  // namespace

std::optional<Identifiability> identifiability_of(const FinishedRun& run, const Truth& truth) {
  const std::vector<slam::StampedPose>& truth_W = run.record.truth_W;
  if (truth.scans.empty() || truth_W.empty()) return std::nullopt;
  const RunBuilding& building = *run.building;
  const bim::Building& as_planned = building.as_planned();
  const bim::Plan& plan = *building.plan_as_planned();
  const auto start = static_cast<std::size_t>(storey_of_base(plan.storeys, truth_W.front().X_FR.t.z()));

  Question question;
  question.yaw_known = run.scenario.prior.yaw == Knowledge::known;
  for (std::size_t i = 0; i < as_planned.storeys.size(); ++i)
    if (i == start || run.scenario.prior.storey == Knowledge::unknown)
      if (const SearchArea area = search_area(as_planned, i); !area.empty()) question.storeys.push_back(area);
  if (question.storeys.empty()) return std::nullopt;  // a mesh
  const std::vector<bim::WalkedFloors> floors = storey_floors(as_planned);
  for (const slam::Nanoseconds t : truth.scans) {
    const Pose X_WR = truth.at(t);
    const Eigen::Vector3d feet_W = X_WR.t - Eigen::Vector3d(0.0, 0.0, base_height_m());
    question.samples.push_back({slam::seconds(t - truth.scans.front()), X_WR, sensor_z_W(floors, feet_W, on_floor_m)});
  }

  const std::optional<IdentifiabilityAnswer> by_building = answer(building, PlanEvidence::building, question);
  if (!by_building) return std::nullopt;
  Identifiability result{*by_building, std::nullopt};
  if (building.movables_tell()) result.with_furniture = answer(building, PlanEvidence::with_furniture, question);
  return result;
}

}  // namespace plumbline::scenarios::score
