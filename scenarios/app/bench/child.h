// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace plumbline::scenarios {

/// What a process of its own cost, cold: nothing of it is in this process' caches of objects.
struct ChildCost {
  double cpu_s = 0.0;        ///< user and system time of all its threads
  double peak_rss_mb = 0.0;  ///< 1 MB = 1e6 bytes
};

/// Runs this program with `arguments`, its output thrown away. Throws EnvironmentError when it cannot be started or
/// does not end with exit code 0.
[[nodiscard]] ChildCost run_self(const std::vector<std::string>& arguments);

}  // namespace plumbline::scenarios
