// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/belief_builder.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "scenarios/metrics/state_names.h"

namespace plumbline::scenarios {

namespace {

ReportBelief belief_at(const BeliefRecord& belief, const std::string& label, const BeliefContext& context) {
  const ReportPlace place = context.place(belief.stamp);
  return {label, slam::seconds(belief.stamp - context.origin), belief.particles, place.at, place.storey};
}

ReportWall wall_of(const Eigen::Vector2d& p0, const Eigen::Vector2d& p1) { return {p0, p1, 0}; }

/// The walls that a hypothesis matched; `right` as the score judges it.
ReportHypothesis hypothesis_of(const slam::Hypothesis& hypothesis, const std::vector<bool>& right,
                               const bim::Plan& as_planned) {
  ReportHypothesis shown{hypothesis.X_WR.t.head<2>(), hypothesis.X_WR.yaw(), hypothesis.mass, {}};
  for (std::size_t i = 0; i < hypothesis.walls.size(); ++i) {
    const slam::WallMatch& match = hypothesis.walls[i];
    ReportMatch matched;
    matched.right = i < right.size() && right[i];
    matched.patch = wall_of((hypothesis.X_WR * match.p0_R).head<2>(), (hypothesis.X_WR * match.p1_R).head<2>());
    for (const bim::PlanFace& face : as_planned.faces)
      if (std::find(match.faces.begin(), match.faces.end(), face.id) != match.faces.end())
        matched.faces.push_back(wall_of(face.p0, face.p1));
    shown.walls.push_back(std::move(matched));
  }
  return shown;
}

ReportWalls walls_at(const BeliefRecord& belief, const std::string& label, const bim::Plan& as_planned,
                     const BeliefContext& context) {
  constexpr std::size_t most = 8;  // hypotheses, so that walls stay apart
  const ReportPlace place = context.place(belief.stamp);
  ReportWalls walls{label, slam::seconds(belief.stamp - context.origin), place.storey, place.at, {}};
  for (std::size_t k = 0; k < std::min(most, belief.hypotheses.size()); ++k) {
    const slam::Hypothesis& hypothesis = belief.hypotheses[k];
    const std::vector<bool> right = context.right ? context.right(belief.stamp, hypothesis) : std::vector<bool>();
    walls.hypotheses.push_back(hypothesis_of(hypothesis, right, as_planned));
  }
  return walls;
}

}  // namespace

void add_beliefs(const MethodRecord& method, const BeliefContext& context, ReportMethod& shown) {
  std::vector<std::size_t> kept;
  std::size_t converged = method.beliefs.size();
  for (std::size_t i = 0; i < method.beliefs.size(); ++i) {
    const BeliefRecord& belief = method.beliefs[i];
    shown.states.push_back(
        {slam::seconds(belief.stamp - context.origin), static_cast<int>(belief.hypotheses.size()), belief.state});
    if (converged == method.beliefs.size() && belief.state == slam::State::converged) converged = i;
    if (!belief.particles.empty() && i <= converged) kept.push_back(i);
  }
  if (kept.empty()) return;
  const bool has_converged = converged < method.beliefs.size();
  const std::string last = kept.back() == converged ? "convergence" : has_converged ? "before convergence" : "end";
  const auto show = [&](std::size_t i, const std::string& label) {
    shown.beliefs.push_back(belief_at(method.beliefs[i], label, context));
  };
  show(kept.front(), "start");
  if (kept.size() > 2) show(kept[kept.size() / 2], "middle");
  if (kept.size() > 1) show(kept.back(), last);
}

void add_matched_walls(const MethodRecord& method, const bim::Plan& as_planned, const BeliefContext& context,
                       ReportMethod& shown) {
  std::vector<std::size_t> before;
  std::optional<std::size_t> converged, last;
  for (std::size_t i = 0; i < method.beliefs.size(); ++i) {
    const BeliefRecord& belief = method.beliefs[i];
    const bool kept = std::any_of(belief.hypotheses.begin(), belief.hypotheses.end(),
                                  [](const slam::Hypothesis& hypothesis) { return !hypothesis.walls.empty(); });
    if (!kept) continue;
    last = i;
    if (!converged && belief.state == slam::State::converged) converged = i;
    if (!converged) before.push_back(i);
  }
  if (!last) return;
  const auto show = [&](std::size_t i, const std::string& label) {
    shown.recognised.push_back(walls_at(method.beliefs[i], label, as_planned, context));
  };
  if (!before.empty()) {
    const std::size_t i = before[before.size() / 2];
    show(i, "while " + std::string(state_name(method.beliefs[i].state)));
  }
  if (converged) show(*converged, "at convergence");
  if (last != converged && (before.empty() || *last != before[before.size() / 2])) show(*last, "at the end");
}

}  // namespace plumbline::scenarios
