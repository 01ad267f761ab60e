// SPDX-License-Identifier: Apache-2.0
#include "scenarios/sweep/slurm.h"

#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "bim/errors.h"
#include "scenarios/host/files.h"
#include "scenarios/host/terminal.h"

namespace plumbline::scenarios {

namespace {

std::string command_of(const SlurmJob& job) {
  std::string text = shell_argument(job.program) + " sweep";
  for (const std::string& word : job.sweep) text += " " + shell_argument(word);
  return text;
}

/// What a command writes to stdout; nothing where it cannot be run or fails.
std::string output_of(const std::string& command, int& code) {
  std::FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) throw EnvironmentError("no shell can be started");
  std::string text;
  std::array<char, 4096> bytes;
  while (const std::size_t got = std::fread(bytes.data(), 1, bytes.size(), pipe)) text.append(bytes.data(), got);
  const int status = ::pclose(pipe);
  code = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
  return text;
}

/// sbatch is there and takes no job: Slurm is not configured, not running, or does not want this one.
class SbatchRefusal : public EnvironmentError {
 public:
  using EnvironmentError::EnvironmentError;
};

/// Removes a script that nobody took, and the folders that were made for it where they are empty.
void remove_unused(const std::string& script, const std::vector<std::string>& made) {
  std::error_code error;
  std::filesystem::remove(script, error);
  for (auto folder = made.rbegin(); folder != made.rend(); ++folder) std::filesystem::remove(*folder, error);
}

/// The job's number that sbatch --parsable gives: "123" or "123;cluster".
std::string submit_script(const std::string& path, const std::string& options) {
  int code = 0;
  std::string text = output_of("sbatch --parsable " + options + " " + shell_argument(path), code);
  text.erase(std::find_if(text.begin(), text.end(), [](char c) { return c < '0' || c > '9'; }), text.end());
  if (code == 0 && !text.empty()) return text;
  constexpr int not_found = 127;
  if (code == not_found) throw EnvironmentError("sbatch is not there; " + path + " can be submitted where it is");
  throw SbatchRefusal("sbatch refused " + path + " with " + std::to_string(code));
}

}  // namespace

std::string shard_folder(const std::string& out, int number, int of) {
  return out + ".shards/" + std::to_string(number) + "-of-" + std::to_string(of);
}

std::string array_script(const SlurmJob& job, int tasks) {
  const std::string throttle = job.at_once > 0 ? "%" + std::to_string(job.at_once) : "";
  return "#!/bin/bash\n"
         "#SBATCH --job-name=" +
         job.name +
         "\n"
         "#SBATCH --array=0-" +
         std::to_string(tasks - 1) + throttle +
         "\n"
         "#SBATCH --requeue\n"
         "#SBATCH --open-mode=append\n"
         "#SBATCH --output=\"" +
         job.out +
         ".shards/%A_%a.log\"\n"
         "# A task that is begun again goes on: runs that are there are kept. Slurm begins it again where a node is "
         "lost; here\n"
         "# it is where one of its processes was killed. What is wrong with the input stays wrong (2), and who stops "
         "it means it.\n"
         "shard=$((SLURM_ARRAY_TASK_ID + 1 + " +
         std::to_string(job.first) +
         "))\n"
         "for try in 1 2 3 4 5; do\n"
         "  code=0\n"
         "  " +
         command_of(job) + " --shard \"$shard/" + std::to_string(job.shards) +
         "\" --jobs \"${SLURM_CPUS_PER_TASK:-1}\" \\\n"
         "    -o " +
         shell_argument(job.out) + ".shards/\"$shard\"-of-" + std::to_string(job.shards) +
         " || code=$?\n"
         "  case $code in 0|2|130|143) break ;; esac\n"
         "done\n"
         "exit $code\n";
}

std::string collect_script(const SlurmJob& job) {
  std::string command = shell_argument(job.program) + " sweep collect";
  for (const std::string& word : job.sweep) command += " " + shell_argument(word);
  return "#!/bin/bash\n"
         "#SBATCH --job-name=" +
         job.name +
         "-collect\n"
         "#SBATCH --requeue\n"
         "#SBATCH --output=\"" +
         job.out +
         ".shards/collect.log\"\n"
         "exec " +
         command + " --from " + shell_argument(job.out) + ".shards/*-of-" + std::to_string(job.shards) + " -o " +
         shell_argument(job.out) + "\n";
}

int longest_array() {
  int code = 0, most = 0;
  const std::string text = output_of("scontrol show config 2>/dev/null", code);
  const std::size_t at = text.find("MaxArraySize");
  if (code == 0 && at != std::string::npos) most = std::atoi(text.c_str() + text.find('=', at) + 1);
  constexpr int usual = 1000;
  return most > 1 ? most - 1 : usual;
}

std::string submit(const SlurmJob& job) {
  const std::vector<std::string> made = make_folders(job.out + ".shards", job.out);
  const int longest = longest_array();
  std::string ids, said;
  for (int first = 0, part = 1; first < job.shards; first += longest, ++part) {
    SlurmJob one = job;
    one.first = first;
    const std::string path = job.out + ".shards/array" + (part == 1 ? "" : std::to_string(part)) + ".sbatch";
    const int tasks = std::min(longest, job.shards - first);
    write_file(path, array_script(one, tasks));
    const std::string id = [&] {
      try {
        return submit_script(path, "");
      } catch (const SbatchRefusal& refusal) {
        if (!ids.empty())
          throw EnvironmentError(std::string(refusal.what()) + "; jobs" + ids + " were submitted before");
        remove_unused(path, made);
        throw EnvironmentError(refusal.what() + std::string("; nothing was submitted and nothing is left behind. Where "
                                                            "sinfo shows no nodes, Slurm is not configured here or "
                                                            "does not run: without --slurm the sweep runs on this "
                                                            "machine, and --shard I/N runs a part of it on another"));
      }
    }();
    ids += ":" + id;
    said += "job " + id + ": " + std::to_string(tasks) + " tasks, " + path + "\n";
  }
  const std::string path = job.out + ".shards/collect.sbatch";
  write_file(path, collect_script(job));
  return said + "job " + submit_script(path, "--dependency=afterany" + ids) + ": the table into " + job.out + ", " +
         path + "\n";
}

}  // namespace plumbline::scenarios
