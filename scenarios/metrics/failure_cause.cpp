// SPDX-License-Identifier: Apache-2.0
#include "scenarios/metrics/failure_cause.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumbline::scenarios::score {

namespace {

constexpr double sampled_m = 0.5;
constexpr double sampled_rad = 15.0 * std::numbers::pi / 180.0;

bool within(const Pose& X_WR, const Pose& X_WR_true, double metres, double radians) {
  return (X_WR.t - X_WR_true.t).norm() <= metres && std::abs(wrap_angle(X_WR.yaw() - X_WR_true.yaw())) <= radians;
}

bool is_right(const Pose& X_WR, const Pose& X_WR_true, const LocalizationRules& rules) {
  return within(X_WR, X_WR_true, rules.position_m, rules.yaw_deg * std::numbers::pi / 180.0);
}

bool is_sampled(const Belief& belief, const Pose& X_WR_true) {
  const double yaw = X_WR_true.yaw();
  return std::any_of(belief.hypotheses.begin(), belief.hypotheses.end(),
                     [&](const slam::Hypothesis& h) { return within(h.X_WR, X_WR_true, sampled_m, sampled_rad); }) ||
         std::any_of(belief.particles.begin(), belief.particles.end(), [&](const slam::Particle& p) {
           return std::hypot(p.x - X_WR_true.t.x(), p.y - X_WR_true.t.y()) <= sampled_m &&
                  std::abs(wrap_angle(p.yaw - yaw)) <= sampled_rad;
         });
}

/// Scans that say nothing of where the robot may be tell nothing of depletion.
bool says_something(const Belief& belief) { return !belief.hypotheses.empty() || !belief.particles.empty(); }

/// Nothing where the true pose is there up to scan `end`; else whether it never was, and since when it is not.
std::optional<FailureAt> missing_until(const Truth& truth, const std::vector<Belief>& beliefs, std::size_t end) {
  std::optional<std::size_t> gone;
  bool ever = false;
  for (std::size_t i = 0; i <= end; ++i) {
    if (!says_something(beliefs[i])) continue;
    if (is_sampled(beliefs[i], truth.at(beliefs[i].stamp))) {
      ever = true;
      gone.reset();
    } else if (!gone) {
      gone = i;
    }
  }
  if (!gone) return std::nullopt;
  return FailureAt{ever ? Failure::depleted : Failure::never_sampled, beliefs[*gone].stamp};
}

/// Why the answer of scan `at` is wrong.
FailureAt wrong_answer(const Truth& truth, const std::vector<Belief>& beliefs, std::size_t at,
                       const std::vector<Pose>& aliases, const LocalizationRules& rules) {
  if (const auto missing = missing_until(truth, beliefs, at)) return *missing;
  const Pose X_WR_true = truth.at(beliefs[at].stamp);
  const bool alias = std::any_of(aliases.begin(), aliases.end(),
                                 [&](const Pose& g) { return is_right(*beliefs[at].X_WR, g * X_WR_true, rules); });
  return {alias ? Failure::alias_preferred : Failure::wrong_model, beliefs[at].stamp};
}

}  // namespace

std::optional<FailureAt> failure_of(const Truth& truth, const std::vector<Belief>& beliefs, LocalizationVerdict verdict,
                                    const std::vector<Pose>& aliases_at_start, const LocalizationRules& rules) {
  using V = LocalizationVerdict;
  if (verdict == V::success || verdict == V::honest_ambiguity || verdict == V::lucky || beliefs.empty())
    return std::nullopt;
  bool was_right = false;
  for (std::size_t i = 0; i < beliefs.size(); ++i) {
    if (!beliefs[i].X_WR || (!was_right && beliefs[i].state != slam::State::converged)) continue;
    const bool right = is_right(*beliefs[i].X_WR, truth.at(beliefs[i].stamp), rules);
    if (!right && !was_right) return wrong_answer(truth, beliefs, i, aliases_at_start, rules);
    if (!right) return FailureAt{Failure::tracking_lost, beliefs[i].stamp};
    was_right = true;
  }
  if (was_right) {
    const auto lost = std::find_if(beliefs.begin(), beliefs.end(),
                                   [](const Belief& belief) { return belief.state == slam::State::lost; });
    return FailureAt{lost != beliefs.end() ? Failure::tracking_lost : Failure::undecided,
                     lost != beliefs.end() ? lost->stamp : beliefs.back().stamp};
  }
  if (const auto missing = missing_until(truth, beliefs, beliefs.size() - 1)) return missing;
  return FailureAt{Failure::undecided, beliefs.back().stamp};
}

}  // namespace plumbline::scenarios::score
