// SPDX-License-Identifier: Apache-2.0
#include "scenarios/sweep/sweep.h"

#include <unistd.h>

#include <cstdio>
#include <memory>
#include <string>

#include "bim/errors.h"
#include "scenarios/commands/commands.h"
#include "scenarios/commands/process.h"
#include "scenarios/run/interrupt.h"

namespace plumbline::scenarios {

namespace {

struct SweepArguments {
  std::string file;
  std::string out;
  int jobs = 0;
  int seeds = 0;
  bool schema = false;
};

int sweep(const SweepArguments& options) {
  if (options.schema) {
    std::fputs(sweep_page().c_str(), stdout);
    return 0;
  }
  if (options.file.empty()) throw InputError({"SWEEP", 0, 0}, "is missing; name a sweep file");
  const Sweep sweep = read_sweep(options.file, options.seeds);
  std::string name = sweep.file.name;
  for (char& c : name)
    if (c == '/' || c == ' ') c = '_';
  SweepOptions run;
  run.out = options.out.empty() ? "sweeps/" + name : options.out;
  run.jobs = options.jobs > 0 ? options.jobs : allowed_cpus();
  if (::isatty(STDERR_FILENO) == 1)
    run.progress = [](std::size_t done, std::size_t all) { std::fprintf(stderr, "\r%zu of %zu runs", done, all); };
  catch_interrupts();
  const std::string table = run_sweep(sweep, run);
  if (run.progress) std::fputc('\n', stderr);
  std::fputs((table + "table: " + run.out + "/table.html\n").c_str(), stdout);
  return 0;
}

}  // namespace

Command add_sweep(CommandLine& program) {
  const auto options = std::make_shared<SweepArguments>();
  CommandLine line = program.add_command("sweep", "Runs scenarios with many seeds and variants; makes one table");
  line.option("SWEEP", options->file, "sweep file (.yaml)");
  line.option("-o,--out", options->out, "folder of the sweep, new or to be gone on with [sweeps/<name>]");
  line.option("--jobs", options->jobs, "runs at a time [the CPUs allowed]").range(1, 1024);
  line.option("--seeds", options->seeds, "how many seeds of each, in place of the file's; what is made stays for more")
      .range(1, 100000);
  line.flag("--schema", options->schema, "prints instead every key of sweep files, with examples");
  line.footer("Example: plumbline sweep ci/sweeps/look.yaml --jobs 2\nStopped at any moment, it goes on where it was.");
  return {line, [options] { return sweep(*options); }};
}

}  // namespace plumbline::scenarios
