// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/report_builder.h"

#include <algorithm>
#include <set>
#include <utility>

#include "bim/model/rooms.h"
#include "scenarios/metrics/storey.h"
#include "scenarios/report/belief_builder.h"
#include "scenarios/report/deviation_sight.h"
#include "scenarios/report/hypothesis_history.h"
#include "scenarios/report/map_drawing.h"
#include "scenarios/score/handover.h"
#include "sim/world.h"

namespace plumbline::scenarios {

namespace {

ReportSample sample(const bim::Plan& plan, slam::Nanoseconds stamp, const Pose& X_WR, double error_m) {
  const int storey = score::storey_of_base(plan.storeys, X_WR.t.z());
  return {slam::seconds(stamp), X_WR.t.x(), X_WR.t.y(), X_WR.yaw(), error_m, storey};
}

/// The causal trajectory as scored: SLAM aligned once over the whole run, localization as it stands.
std::vector<ReportSample> samples_of(const bim::Plan& plan, const MethodRecord& method, const score::Truth& truth) {
  const std::vector<score::PosePair> pairs = score::associate(truth, method.causal, {});
  std::vector<ReportSample> samples;
  if (pairs.empty()) return samples;
  const Pose X_WF = method.localization ? Pose() : score::umeyama(pairs);
  const Pose shown_X_WF = method.localization ? Pose() : score::place_map(pairs);
  const std::vector<std::optional<double>> relative =
      score::errors_over(pairs, truth.walked(), score::TrajectoryRules{}.rpe_distance_m);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const score::PosePair& pair = pairs[i];
    const Pose X_WR = shown_X_WF * pair.X_FR;
    const Eigen::Vector3d error_W = X_WF * pair.X_FR.t - pair.X_WR.t;
    samples.push_back(sample(plan, truth.scans[pair.scan], X_WR, error_W.norm()));
    samples.back().lost = said_lost(method, truth.scans[pair.scan]);
    samples.back().error_W = error_W;
    samples.back().yaw_error = (pair.X_WR.inverse() * X_WR).yaw();
    samples.back().relative_m = relative[i];
  }
  return samples;
}

Eigen::Vector3d place(const Pose& X_WF, const Eigen::Vector2d& p_F, double z_F = 0.0) {
  return X_WF * Eigen::Vector3d(p_F.x(), p_F.y(), z_F);
}

void add_structure(const bim::Plan& plan, const MethodRecord& method, const score::MethodScore& score,
                   ReportMethod& shown) {
  const Pose X_WF = method.localization || !score.trajectory ? Pose() : score.trajectory->X_WF_final;
  for (const slam::PlaneNode& plane : method.estimate.planes) {
    const Eigen::Vector3d p0_W = place(X_WF, plane.p0, 0.5 * (plane.z0 + plane.z1));
    const int storey = score::storey_of_height(plan.storeys, p0_W.z());
    shown.walls.push_back({p0_W.head<2>(), place(X_WF, plane.p1).head<2>(), storey});
  }
  for (std::size_t i = 0; i < method.estimate.rooms.size(); ++i) {
    const slam::RoomNode& node = method.estimate.rooms[i];
    ReportRoom room;
    for (const Eigen::Vector2d& p : node.polygon_F) room.polygon_W.push_back(place(X_WF, p).head<2>());
    room.matched = score.rooms && score.rooms->room_of_node[i] >= 0;
    const double z_F = score::height_of_room(method.estimate, node).value_or(0.0);
    room.storey = score::storey_of_height(plan.storeys, place(X_WF, node.center_F, z_F).z());
    shown.rooms.push_back(std::move(room));
  }
}

/// When a method was first lost or, by its score, wrong.
std::optional<double> failed_s(const ReportMethod& method, const score::MethodScore& score) {
  if (method.localization) return score.localization ? score.localization->failure_at_s : std::nullopt;
  const auto failed = std::find_if(method.samples.begin(), method.samples.end(), [](const ReportSample& sample) {
    return sample.lost || sample.error_m > score::TrajectoryRules().far_off_m;
  });
  return failed == method.samples.end() ? std::nullopt : std::optional(failed->t_s);
}

/// The storey of the start and those the robot was on, from the lowest up.
std::string name_of(const bim::Storey& storey) { return storey.name.empty() ? storey.id : storey.name; }

std::vector<ReportStorey> storeys_of(const FinishedRun& run, const std::vector<ReportSample>& truth) {
  const std::vector<bim::Storey>& storeys = run.building->as_built().storeys;
  std::set<std::pair<double, int>> shown;
  const auto show = [&](int index) { shown.emplace(storeys.at(static_cast<std::size_t>(index)).elevation_m, index); };
  for (const ReportSample& at : truth) show(at.storey);
  for (std::size_t i = 0; i < storeys.size(); ++i)
    if (storeys[i].id == run.scenario.start.storey) show(static_cast<int>(i));
  if (shown.empty()) show(0);
  std::vector<ReportStorey> out;
  for (const auto& [elevation, index] : shown) {
    const bim::Storey& storey = storeys[static_cast<std::size_t>(index)];
    out.push_back({index, name_of(storey), report_deviations(run.building->variants(), index)});
  }
  return out;
}

std::vector<TruthSample> walk_of(const score::Truth& truth) {
  std::vector<TruthSample> walk;
  for (const slam::Nanoseconds stamp : truth.scans) {
    const Pose X_WR = truth.at(stamp);
    walk.push_back(
        {slam::seconds(stamp), X_WR, X_WR.t.z() - score::base_height_m() + sim::World::calibration().sensor_height_m});
  }
  return walk;
}

/// Where the robot was, and which walls of a hypothesis it was that it saw.
BeliefContext beliefs_by_truth(const FinishedRun& run, const score::RunScore& score, const bim::Plan& plan) {
  BeliefContext context;
  context.place = [&](slam::Nanoseconds stamp) {
    const Eigen::Vector3d p_W = score.truth.at(stamp).t;
    return ReportPlace{p_W.head<2>(), score::storey_of_base(plan.storeys, p_W.z())};
  };
  context.right = [&](slam::Nanoseconds stamp, const slam::Hypothesis& hypothesis) {
    return score::right_matches(hypothesis.walls, score.truth.at(stamp), *run.building->plan_as_planned(),
                                run.building->plan_as_built());
  };
  return context;
}

/// Method i of the run, without its ink.
ReportMethod method_of(const FinishedRun& run, const score::RunScore& score, std::size_t i, const bim::Plan& plan) {
  constexpr std::size_t shown_places = 6;  // curves that stay apart
  const MethodRecord& method = run.record.methods[i];
  ReportMethod shown;
  shown.name = method.name;
  shown.localization = method.localization;
  shown.samples = samples_of(plan, method, score.truth);
  add_structure(plan, method, score.methods[i], shown);
  const BeliefContext context = beliefs_by_truth(run, score, plan);
  add_beliefs(method, context, shown);
  HypothesisHistories histories = hypothesis_histories(method.beliefs, score.truth, shown_places);
  shown.histories = std::move(histories.shown);
  shown.other_hypotheses = std::move(histories.others);
  shown.hypotheses_left_out = histories.left_out;
  for (HypothesisHistory& history : shown.histories)
    history.room = bim::room_name(run.building->as_built().rooms, history.room);
  add_matched_walls(method, *run.building->plan_as_planned(), context, shown);
  shown.failed_s = failed_s(shown, score.methods[i]);
  if (shown.failed_s) shown.slip = slip_before(run.scenario, *shown.failed_s);
  return shown;
}

}  // namespace

ReportInput report_input(const FinishedRun& run, const score::RunScore& score) {
  ReportInput input;
  input.results = read_json(score::write_results(run, score), "results.json");
  input.plan = run.building->plan_as_built();
  input.obstacles = obstacles_of(run.building->as_built(), run.building->plan_as_built());
  input.flights = flights_of(run.building->as_built());
  const std::vector<bim::Room>& rooms = run.building->as_built().rooms;
  for (std::size_t i = 0; i < input.plan.storeys.size(); ++i)
    input.plan.storeys[i].name = name_of(run.building->as_built().storeys[i]);
  for (bim::PlanRoom& room : input.plan.rooms) room.name = bim::room_name(rooms, room.name);
  for (const slam::Nanoseconds stamp : score.truth.scans)
    input.truth.push_back(sample(input.plan, stamp, score.truth.at(stamp), 0.0));
  input.storeys = storeys_of(run, input.truth);
  const std::vector<TruthSample> walk = walk_of(score.truth);
  for (ReportStorey& storey : input.storeys) set_sights(*run.building, walk, storey.deviations);
  if (score.truth.set_down) {
    const auto down = std::find(score.truth.scans.begin(), score.truth.scans.end(), *score.truth.set_down);
    input.kidnap = ReportKidnap{slam::seconds(*(down - 1)), slam::seconds(*down)};
  }
  std::size_t inks = 0;
  for (std::size_t i = 0; i < run.record.methods.size(); ++i) {
    ReportMethod shown = method_of(run, score, i, input.plan);
    shown.ink = inks;
    if (!is_truth(shown)) ++inks;
    input.methods.push_back(std::move(shown));
  }
  return input;
}

}  // namespace plumbline::scenarios
