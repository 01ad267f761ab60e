// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace plumbline::scenarios {

/// A sweep as an array job of Slurm: task I runs shard I + 1, and is begun again where its node dies.
struct SlurmJob {
  std::string name;                ///< of the sweep
  std::string program;             ///< this program, by its whole path
  std::vector<std::string> sweep;  ///< its arguments: the sweep file by its whole path, and what goes with it
  std::string out;                 ///< folder that all nodes see, by its whole path
  int shards = 1;
  int at_once = 0;  ///< tasks at a time, 0: as many as the cluster gives
  int first = 0;    ///< number of the first task of this array, where the cluster takes no longer ones
};

/// Where shard `number` of a sweep in `out` has its results.
[[nodiscard]] std::string shard_folder(const std::string& out, int number, int of);

/// Scripts for sbatch: tasks first to last of the array, and the job that collects what they left.
[[nodiscard]] std::string array_script(const SlurmJob& job, int tasks);
[[nodiscard]] std::string collect_script(const SlurmJob& job);

/// Longest array that the cluster takes (MaxArraySize less one), or 1000 where it does not tell.
[[nodiscard]] int longest_array();
/// Writes the scripts into `out` and gives them to sbatch, the collector after all tasks have ended, however they did.
/// Gives lines that say what was submitted. Throws EnvironmentError where sbatch cannot be run or refuses;
/// where it refuses the first script, none is left.
[[nodiscard]] std::string submit(const SlurmJob& job);

}  // namespace plumbline::scenarios
