// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenarios/report/report.h"

/// What tests of the report begin with.
namespace plumbline::scenarios {

inline ReportInput sample() {
  ReportInput input;
  Tree gate = Tree::map();
  gate.set("metric", "ate_aligned_rmse_m").set("method", "m").set("op", "<=").set("limit", 0.05).set("value", 0.08);
  gate.set("passed", false);
  Tree method = Tree::map();
  method.set("verdict", "complete").set("ate_aligned_rmse_m", 0.08);
  input.results = Tree::map();
  input.results.set("scenario", "a <b> & \"c\"").set("seed", "1").set("duration_s", 10.0);
  input.results.set("gates", Tree(Tree::List{gate})).set("methods", Tree(Tree::Map{{"m", method}}));
  bim::PlanFace face;
  face.storey = 0;
  face.p1 = {4.0, 0.0};
  face.holes = {{1.0, 2.0, 0.0, 2.1}};
  input.plan.faces = {face};
  input.plan.storeys = {{"ground", 0.0, 3.0}, {"upper", 3.0, 3.0}};
  input.storeys = {{0, "ground", {}}};
  for (int i = 0; i <= 100; ++i) input.truth.push_back({0.1 * i, 0.04 * i, 1.0, 0.0, 0.0, 0});
  ReportMethod m;
  m.name = "m";
  for (const auto& s : input.truth) m.samples.push_back({s.t_s, s.x, s.y + 0.08, 0.0, 0.08, 0});
  m.beliefs.push_back({"start", 0.0, {{1.0, 1.0, 0.0, 1.0}}, {0.0, 1.0}, 0});
  input.methods.push_back(m);
  return input;
}

/// A localization that had two hypotheses, converged at 6 s and matched two walls, one of them wrongly.
inline ReportInput localized() {
  ReportInput input = sample();
  ReportMethod& m = input.methods.front();
  m.localization = true;
  for (const ReportSample& s : input.truth)
    m.states.push_back({s.t_s, s.t_s < 6.0 ? 2 : 1, s.t_s < 6.0 ? slam::State::ambiguous : slam::State::converged});
  m.histories = {{0, true, "hall", {{0.0, 0.5}, {0.9, 0.9}}}, {1, false, "a<b", {{0.0, 0.5}, {0.9, 0.1}}}};
  const ReportWall wall{{0, 0}, {4, 0}, 0};
  m.recognised = {
      {"at convergence", 6.0, 0, {1.0, 1.0}, {{{1.0, 1.0}, 0.5, 1.0, {{{wall}, wall, true}, {{wall}, wall, false}}}}}};
  Tree results = Tree::map();
  results.set("verdict", "success");
  results.set("localization", Tree::map().set("converged_at_s", 6.0).set("ape_rmse_m", 0.08));
  input.results.set("methods", Tree(Tree::Map{{"m", results}}));
  return input;
}

}  // namespace plumbline::scenarios
