// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bim/config/tree.h"

namespace plumbline::scenarios {

/// A gate that failed, as results.json has it.
struct FailedGate {
  std::string metric;
  std::string op;
  double limit = 0.0;
  std::optional<double> value;
};

/// How one method of a run failed. Two runs fail the same way where all of this is equal. Of a gate: it fails again, by
/// half of the excess at least, or again for want of a value; so a walk too short to fail passes for none.
struct FailureSignature {
  std::string method;
  std::string verdict;
  std::string evidence;            ///< of a localization: how far scans and plan determine the pose
  std::string cause;               ///< of a localization: see failure_cause.h
  std::string error;               ///< of a crash: its message, each number as '#'
  std::optional<FailedGate> gate;  ///< what failed where the verdict is a good one, or where it is asked for
};

/// Whether a verdict is no answer that a user wants: none of complete, success and honest_ambiguity.
[[nodiscard]] bool is_bad_verdict(std::string_view verdict);

/// Every failure of a run, by its results.json: of each failed gate, but for methods with a bad verdict, which says
/// more than a gate, that verdict; then other bad verdicts. With all_gates, gates of such methods, too.
[[nodiscard]] std::vector<FailureSignature> failures_in(const Tree& results, bool all_gates = false);

/// The first failure, of this method and this gate's metric where they are not empty. Throws InputError where the run
/// has none, in words about `dir`.
[[nodiscard]] FailureSignature chosen_failure(const Tree& results, const std::string& dir, const std::string& method,
                                              const std::string& metric);

/// Why a run does not fail this way, a few words; empty where it does.
[[nodiscard]] std::string difference_to(const FailureSignature& failure, const Tree& results);

/// "s_graph_localization: false_convergence (twin_preferred), evidence unique".
[[nodiscard]] std::string describe(const FailureSignature& failure);
[[nodiscard]] Tree to_results(const FailureSignature& failure);

}  // namespace plumbline::scenarios
