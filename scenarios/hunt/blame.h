// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bim/config/tree.h"
#include "scenarios/shrink/failure_signature.h"

namespace plumbline::scenarios {

/// Whose fault a failure is.
struct Blame {
  bool of_method = false;
  std::string why;
};

/// By the run that it is of:
/// - crashed, false_convergence and overconfident are the method's fault.
/// - Of a localization everything else is where the evidence is `unique`: scans and plan determine the pose in time, by
///   what the method was told. `lucky` never is.
/// - Of SLAM a lost pose is where another method of the run, the truth aside, had a pose for the whole walk, at most
///   0.5 m off; a failed gate where another kept the same bound.
[[nodiscard]] Blame blame_of(const FailureSignature& failure, const Tree& results);

/// What one method did in one run.
struct MethodOutcome {
  std::string method;
  std::string verdict;
  std::string evidence;
  std::optional<double> error_m;            ///< of the position: of a localization in W, of SLAM aligned
  std::optional<FailureSignature> failure;  ///< the first one of the method
  Blame blame;
  double badness = 0.0;
};

/// Of every method but the truth, in the order of the run.
[[nodiscard]] std::vector<MethodOutcome> outcomes_of(const Tree& results);

/// Of a method that ended the whole program.
[[nodiscard]] MethodOutcome died(const std::string& method, const std::string& why);

/// How near a method came to failing by its own fault, or how badly it did: with the share s = error / (error + 0.5 m),
/// s where it did well, 1 + s of a failure that is its fault, 2 of a crash, 0 of one that is not its fault.
[[nodiscard]] double badness_of(const MethodOutcome& outcome);

/// Order of failures in a list, the worst first: crashed, false_convergence, overconfident, lost, late, gates.
[[nodiscard]] int severity_rank(const FailureSignature& failure);

}  // namespace plumbline::scenarios
