// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenarios/metrics/trajectory.h"
#include "slam/io/estimate.h"

namespace plumbline::scenarios::score {

/// Rules of plan localization, docs/reference/metrics.md.
struct LocalizationRules {
  double position_m = 0.5;     ///< a pose is right within this
  double yaw_deg = 10.0;       ///< and this
  double hold_s = 5.0;         ///< how long it must stay right, to the end
  double hold_m = 1.0;         ///< and over how much walking
  double claimed_mass = 0.02;  ///< a hypothesis with less is listed, not claimed
};

/// What a plan localization reported after one scan.
struct Belief {
  slam::Nanoseconds stamp = 0;
  slam::State state = slam::State::searching;
  std::optional<Pose> X_WR;
  std::vector<slam::Hypothesis> hypotheses;
  std::vector<slam::Particle> particles;  ///< a sample, of some scans
};

/// How many aliased poses were left at a time of the run, the true one left out.
struct AliasesLeft {
  double t_s = 0.0;
  double distance_m = 0.0;
  int aliases = 0;
  int marginal = 0;  ///< of them, those that are nearly ruled out
};

/// What ruled out the last other pose.
struct DecidingElement {
  std::string id;
  bool missing = false;  ///< it would be visible from the other pose, and is not; else it is visible, and would not be
  double share = 0.0;    ///< of the evidence
};

/// What can be known of the pose on this route by one kind of evidence, from scenarios/localizability.
struct IdentifiabilityAnswer {
  bool identifiable = false;
  std::optional<double> at_s;
  std::optional<double> at_m;
  /// First time from which on no other pose explains what was seen as well as the true one does (all are at least
  /// marginal); a single answer given before is luck.
  std::optional<double> marginal_from_s;
  std::vector<Pose> others_W;  ///< poses at the end that explain the scans as the true one does; empty when unique
  std::vector<Pose> aliases_at_start;  ///< X_alias = alias * X_WR, left by the first scan
  std::vector<AliasesLeft> places;     ///< at the start and wherever their numbers change
  std::optional<DecidingElement> decided_by;
};

/// Both answers: by the building alone, which verdicts use, since what may have moved never makes a single answer right
/// by itself; and with the furniture as planned. A run is scored without it where it has not been computed.
struct Identifiability : IdentifiabilityAnswer {
  /// Absent where it is the same, since nothing planned may have moved or all of it is gone, and where methods are not
  /// told of it.
  std::optional<IdentifiabilityAnswer> with_furniture;
};

enum class LocalizationVerdict { success, false_convergence, overconfident, honest_ambiguity, late, lost, lucky };
[[nodiscard]] std::string to_string(LocalizationVerdict verdict);
/// A single wrong answer, or one that nothing justified: false_convergence or overconfident.
[[nodiscard]] constexpr bool is_sure_and_wrong(LocalizationVerdict verdict) {
  return verdict == LocalizationVerdict::false_convergence || verdict == LocalizationVerdict::overconfident;
}

/// What the plan allows to be known of a run's pose, docs/methods/localizability.md.
enum class Evidence {
  unique,    ///< no aliased pose is left, early enough for an answer to be held to the end
  marginal,  ///< "weak" in files: the aliased poses are nearly ruled out, so that one right answer and an honest
             ///< ambiguity are both right; or they were ruled out too late for an answer to be held
  ambiguous  ///< aliased poses explain the scans as well as the true one
};
[[nodiscard]] std::string to_string(Evidence evidence);

/// Why a plan localization failed, from what it reported after each scan.
enum class Failure {
  never_sampled,    ///< the true pose was never among the hypotheses or the particles kept
  depleted,         ///< it was, and was dropped before the answer was given or the run ended
  alias_preferred,  ///< "twin_preferred" in files: a pose aliased with it at the start was chosen over it
  wrong_model,      ///< a pose not aliased with it was
  tracking_lost,    ///< the right answer was given, and lost
  undecided         ///< it was there to the end, and never chosen
};
[[nodiscard]] std::string to_string(Failure failure);

/// What the furniture as planned would allow to be known besides.
struct WithFurniture {
  bool identifiable = false;
  Evidence evidence = Evidence::ambiguous;
  std::optional<double> at_s;
  std::optional<double> at_m;
  int aliases = 0;  ///< left at the end
};

struct LocalizationScore {
  LocalizationVerdict verdict = LocalizationVerdict::late;
  slam::State state = slam::State::searching;  ///< at the end
  std::optional<double> converged_at_s;        ///< first convergence, since the first scan
  std::optional<double> converged_at_m;        ///< distance walked until then
  std::optional<double> ape_rmse_m;            ///< in W, over every scan from the first convergence on
  std::optional<double> yaw_rmse_deg;
  int hypotheses = 0;  ///< at the end
  std::optional<bool> identifiable;
  std::optional<Evidence> evidence;
  std::optional<double> identifiable_at_s;
  std::optional<double> identifiable_at_m;
  std::optional<WithFurniture> with_furniture;  ///< absent as in Identifiability
  /// Only furniture tells the poses apart: the building alone is ambiguous.
  bool evidence_by_furniture = false;
  /// As ape_rmse_m, each pose held against the nearest of the true one and its aliases at the start: a small value
  /// beside a large ape_rmse_m means that an aliased pose was tracked.
  std::optional<double> aliased_error_rmse_m;
  std::optional<double> true_mass;  ///< share of the last hypotheses that are right
  std::optional<double> nees;       ///< mean of e' P^-1 e of (x, y, yaw) while converged and right; 3 where P is honest
  std::optional<double> nees_left_out;       ///< scans that are converged and right, but without a usable covariance
  std::optional<double> handover_precision;  ///< see handover.h
  std::optional<Failure> failure;
  std::optional<double> failure_at_s;    ///< on the run's clock: `replay --until` stops there
  std::optional<double> kidnap_wrong_s;  ///< longest time a wrong pose stood as CONVERGED after it was set down
  std::optional<double> kidnap_found_s;  ///< since it was set down, until the pose was CONVERGED and right to the end
  std::optional<double> kidnap_found_m;  ///< walked until then
};

/// Scores the beliefs of a run, one a scan in time order; nothing is ever aligned. A scan without a pose after the
/// first convergence is held against the last pose given. A robot that was kidnapped is judged by what was
/// reported before; the kidnap_* values describe the time after it, and state and hypotheses are those of the end.
[[nodiscard]] LocalizationScore score_localization(const Truth& truth, const std::vector<Belief>& beliefs,
                                                   const std::optional<Identifiability>& identifiability,
                                                   const LocalizationRules& rules = {});

}  // namespace plumbline::scenarios::score
