// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenarios/score/trajectory.h"
#include "slam/io/estimate.h"

namespace plumbline::scenarios::score {

/// Rules of plan localization [contract: Metrics].
struct LocalizationRules {
  double position_m = 0.5;  ///< a pose is right within this
  double yaw_deg = 10.0;    ///< and this
  double hold_s = 5.0;      ///< how long it must stay right, to the end
  double hold_m = 1.0;      ///< and over how much walking
};

/// What a plan localization said after one scan.
struct Belief {
  slam::Nanoseconds stamp = 0;
  slam::State state = slam::State::searching;
  std::optional<Pose> X_WR;
  std::vector<slam::Hypothesis> hypotheses;
};

/// What the plan allows to be known on this route, from scenarios/identify. A run is scored without it where it has
/// not been computed.
struct Identifiability {
  bool identifiable = false;
  std::optional<double> at_s;
  std::optional<double> at_m;
  /// First time from which on no other pose explains what was seen as well as the true one does (all are at least
  /// weak); a single answer given before is luck.
  std::optional<double> tellable_from_s;
  std::vector<Pose> others_W;  ///< poses at the end that the plan cannot tell from the true one; empty when unique
};

enum class LocalizationVerdict { success, false_convergence, overconfident, honest_ambiguity, late, lost, lucky };
[[nodiscard]] std::string to_string(LocalizationVerdict verdict);

struct LocalizationScore {
  LocalizationVerdict verdict = LocalizationVerdict::late;
  slam::State state = slam::State::searching;  ///< at the end
  std::optional<double> converged_at_s;        ///< first convergence, since the first scan
  std::optional<double> converged_at_m;        ///< distance walked until then
  std::optional<double> ape_rmse_m;            ///< in W, over every scan from the first convergence on
  std::optional<double> yaw_rmse_deg;
  int hypotheses = 0;  ///< at the end
  std::optional<bool> identifiable;
  std::optional<double> identifiable_at_s;
  std::optional<double> identifiable_at_m;
};

/// Scores the beliefs of a run, one a scan in time order; nothing is ever aligned. A scan without a pose after the
/// first convergence is held against the last pose given.
[[nodiscard]] LocalizationScore score_localization(const Truth& truth, const std::vector<Belief>& beliefs,
                                                   const std::optional<Identifiability>& identifiability,
                                                   const LocalizationRules& rules = {});

}  // namespace plumbline::scenarios::score
