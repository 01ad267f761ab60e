// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bim/config/tree.h"
#include "scenarios/shrink/failure_signature.h"
#include "scenarios/shrink/run_case.h"
#include "scenarios/shrink/trial.h"

namespace plumbline::scenarios {

/// What a search may make smaller, in this order.
inline constexpr std::array<std::string_view, 4> shrink_stages = {"duration", "ingredients", "route", "building"};

struct ShrinkOptions {
  std::string named;  ///< the run, in messages
  std::string work;   ///< folder for what is tried, which is there
  int max_runs = 200;
  int jobs = 1;                                 ///< decides about time alone
  std::vector<std::string> keep;                ///< stages that are left out
  std::function<void(int runs)> progress = {};  ///< called after each run that counts
  TryCases try_all = {};                        ///< in place of in_processes()
};

/// Something that was tried.
struct ShrinkStep {
  std::string what;   ///< what was left out or cut
  bool kept = false;  ///< it still failed the same way without
  std::string why;    ///< where it did not, why
};

/// How large a run is.
struct CaseSize {
  double duration_s = 0.0;
  double distance_m = 0.0;
  int methods = 0;
  int rooms = 0;                        ///< of the route, each as often as it is walked to
  std::optional<std::size_t> elements;  ///< of the building, where it is a plan
};

enum class ShrinkEnd { smallest, max_runs, interrupted };
[[nodiscard]] constexpr std::array<std::string_view, 3> names_of(ShrinkEnd) {
  return {"smallest", "max_runs", "interrupted"};
}

/// The smallest run found that fails as one did.
struct Shrunk {
  FailureSignature failure;
  RunCase best;
  CaseSize before, after;
  /// Ingredients: those that were tried alone and must stay, those that went, and those that were not tried.
  std::vector<std::string> needed, not_needed, not_tried;
  std::vector<ShrinkStep> steps;
  int runs = 0;
  ShrinkEnd end = ShrinkEnd::smallest;
  int signal = 0;  ///< that interrupted it
};

/// Searches for the smallest run that fails the same way: the failing method alone; a shorter walk with time to spare;
/// fewer ingredients and a shorter route, until none of these can go alone; no time to spare; fewer elements of a plan,
/// until none of these can go alone. `results`: results.json of the run that `whole` makes. Throws InputError where it
/// does not fail this way when it is run again, as far as `max_runs` shows.
[[nodiscard]] Shrunk shrink(const RunCase& whole, const Tree& results, const FailureSignature& failure,
                            const ShrinkOptions& options);

}  // namespace plumbline::scenarios
