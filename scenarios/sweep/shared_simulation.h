// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "slam/methods.h"

namespace plumbline::scenarios {

/// Keys of a scenario that decide about its methods and their scores, and not about what the robot and its sensors do.
inline constexpr std::array<std::string_view, 4> method_keys = {"prior", "methods", "sensors", "gates"};

/// Runs of one seed whose scenario files differ in method_keys alone, which the caller warrants: simulated once, every
/// method of each fed from that, each scored by itself. A file NAME.yaml leaves NAME/results.json, to the last bit what
/// `run` makes of it, and NAME/digests.json, see digests_by_part(). Returns false where the scenario failed on its way,
/// which is also said on stderr. Throws InputError, ScenarioFailure where it failed before the first scan, Interrupted
/// and EnvironmentError.
[[nodiscard]] bool run_shared(const std::vector<std::string>& files, std::uint64_t seed, slam::MethodTable table);

}  // namespace plumbline::scenarios
