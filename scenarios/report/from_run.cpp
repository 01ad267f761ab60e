// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/from_run.h"

#include <algorithm>

namespace plumbline::scenarios {

namespace {

ReportSample sample(slam::Nanoseconds stamp, const Pose& X_WR, double error_m) {
  return {slam::seconds(stamp), X_WR.t.x(), X_WR.t.y(), X_WR.yaw(), error_m};
}

/// The causal trajectory as scored: SLAM aligned once over the whole run, localization as it stands.
std::vector<ReportSample> samples_of(const MethodRecord& method, const score::Truth& truth) {
  const std::vector<score::PosePair> pairs = score::associate(truth, method.causal, {});
  std::vector<ReportSample> samples;
  if (pairs.empty()) return samples;
  const Pose X_WF = method.localization ? Pose() : score::umeyama(pairs);
  for (const score::PosePair& pair : pairs) {
    const Pose X_WR = X_WF * pair.X_FR;
    samples.push_back(sample(truth.scans[pair.scan], X_WR, (X_WR.t - pair.X_WR.t).norm()));
  }
  return samples;
}

Eigen::Vector2d place(const Pose& X_WF, const Eigen::Vector2d& p_F) {
  return (X_WF * Eigen::Vector3d(p_F.x(), p_F.y(), 0.0)).head<2>();
}

void add_structure(const MethodRecord& method, const score::MethodScore& score, ReportMethod& shown) {
  const Pose X_WF = method.localization || !score.trajectory ? Pose() : score.trajectory->X_WF_final;
  for (const slam::PlaneNode& plane : method.estimate.planes)
    shown.walls.push_back({place(X_WF, plane.p0), place(X_WF, plane.p1)});
  for (std::size_t i = 0; i < method.estimate.rooms.size(); ++i) {
    ReportRoom room;
    for (const Eigen::Vector2d& p : method.estimate.rooms[i].polygon_F) room.polygon_W.push_back(place(X_WF, p));
    room.matched = score.rooms && score.rooms->room_of_node[i] >= 0;
    shown.rooms.push_back(std::move(room));
  }
}

ReportBelief belief_at(const MethodRecord& method, std::size_t i, const std::string& label, const score::Truth& truth) {
  const BeliefRecord& belief = method.beliefs[i];
  return {label, slam::seconds(belief.stamp), belief.particles, truth.at(belief.stamp).t.head<2>()};
}

/// Particles at the start, half-way to the convergence (or the end) and there.
void add_beliefs(const MethodRecord& method, const score::Truth& truth, ReportMethod& shown) {
  std::vector<std::size_t> kept;
  std::size_t converged = method.beliefs.size();
  for (std::size_t i = 0; i < method.beliefs.size(); ++i) {
    const BeliefRecord& belief = method.beliefs[i];
    shown.states.push_back({slam::seconds(belief.stamp), static_cast<int>(belief.hypotheses.size()), belief.state});
    if (converged == method.beliefs.size() && belief.state == slam::State::converged) converged = i;
    if (!belief.particles.empty() && i <= converged) kept.push_back(i);
  }
  if (kept.empty()) return;
  const bool has_converged = converged < method.beliefs.size();
  const std::string last = kept.back() == converged ? "convergence" : has_converged ? "before convergence" : "end";
  shown.beliefs.push_back(belief_at(method, kept.front(), "start", truth));
  if (kept.size() > 2) shown.beliefs.push_back(belief_at(method, kept[kept.size() / 2], "middle", truth));
  if (kept.size() > 1) shown.beliefs.push_back(belief_at(method, kept.back(), last, truth));
}

}  // namespace

ReportInput report_input(const RunFiles& files, const score::RunScore& score) {
  ReportInput input;
  input.results = read_json(score::write_results(files, score), "results.json");
  input.plan = score.as_built;
  const std::vector<bim::Room>& rooms = files.site.as_built.rooms;
  for (bim::PlanRoom& room : input.plan.rooms) {
    const auto named =
        std::find_if(rooms.begin(), rooms.end(), [&](const bim::Room& candidate) { return candidate.id == room.name; });
    if (named != rooms.end() && !named->name.empty()) room.name = named->name;
  }
  for (std::size_t i = 0; i < files.site.as_built.storeys.size(); ++i)
    if (files.site.as_built.storeys[i].id == files.scenario.start.storey) input.storey = static_cast<int>(i);
  input.deviations = report_deviations(files.site, input.storey);
  for (const slam::Nanoseconds stamp : score.truth.scans)
    input.truth.push_back(sample(stamp, score.truth.at(stamp), 0.0));
  for (std::size_t i = 0; i < files.methods.size(); ++i) {
    const MethodRecord& method = files.methods[i];
    ReportMethod shown;
    shown.name = method.name;
    shown.localization = method.localization;
    shown.samples = samples_of(method, score.truth);
    add_structure(method, score.methods[i], shown);
    add_beliefs(method, score.truth, shown);
    input.methods.push_back(std::move(shown));
  }
  return input;
}

}  // namespace plumbline::scenarios
