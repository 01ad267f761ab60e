// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/sweep/sweep_file.h"

namespace plumbline::scenarios {

/// Part `number` of `of` of a sweep: whole walks, so that runs that share one stay together. Which runs are in it does
/// not depend on what is there already.
struct Shard {
  int number = 1;
  int of = 1;
};

struct SweepOptions {
  std::string out;
  std::optional<Shard> shard;  ///< only this part, without tables
  int jobs = 1;
  std::vector<std::string> pages;  ///< keys of runs to be made again with their pages, or "worst"
  std::function<void(std::size_t done, std::size_t all)> resumed;   ///< called where runs are there already
  std::function<void(std::size_t done, std::size_t all)> progress;  ///< called after each run; may be empty
};

/// What a sweep has to say when its files are written.
struct SweepTables {
  std::string text;                ///< the table
  std::vector<std::string> notes;  ///< see walk_notes()
  std::string refused;             ///< see refused_in()
  std::string broken = {};         ///< see broken_in()
};

/// Makes the results that are not there yet, those of one walk in a child process, then the tables from all of them. A
/// run that refuses its input is a failed one beside others. Throws InputError where every run does or where another
/// sweep stands in `out`, EnvironmentError, and Interrupted; what is there by then stays.
[[nodiscard]] SweepTables run_sweep(const Sweep& sweep, const SweepOptions& options);

/// Makes the tables in `out` from the results that shards left in these folders. Throws InputError where a run is in
/// none of them, or differs between two.
[[nodiscard]] SweepTables collect_sweep(const Sweep& sweep, const std::vector<std::string>& folders,
                                        const std::string& out);

/// Number of walks, the most shards that a sweep can be cut into.
[[nodiscard]] int walks_of(const Sweep& sweep);

}  // namespace plumbline::scenarios
