// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "bim/config/tree.h"

namespace plumbline::scenarios {

/// What a run is made of: a scenario and the building beside it.
struct RunCase {
  Tree scenario;                             ///< its `building` is `building`, its processes have whole folders
  std::string building;                      ///< name of the building's file
  std::shared_ptr<const std::string> bytes;  ///< of that file, which many runs may share
};

/// Of a run directory, or of any scenario with its building. Throws InputError.
[[nodiscard]] RunCase read_case(const std::string& scenario_path);
/// Writes both into a folder that is there; the scenario as scenario.yaml. Throws EnvironmentError.
void write_case(const std::string& folder, const RunCase& run);
/// Throws InputError where the form of the scenario is wrong.
void check_case(const RunCase& run);
[[nodiscard]] std::uint64_t seed_of(const RunCase& run);
[[nodiscard]] std::uint64_t digest_of(const RunCase& run);

}  // namespace plumbline::scenarios
