// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/bench/bench.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "bim/errors.h"
#include "scenarios/app/commands.h"
#include "scenarios/host/progress.h"
#include "scenarios/spec/library.h"

namespace plumbline::scenarios {

namespace {

struct BenchOptions {
  std::string part;
  BenchSetting setting;
  bool json = false;
};

const BenchPart& part_of(const std::string& name) {
  std::vector<std::string> known;
  for (const BenchPart& part : bench_parts()) {
    if (part.name == name) return part;
    known.emplace_back(part.name);
  }
  std::string list;
  for (const std::string& one : known) list += (list.empty() ? "" : ", ") + one;
  throw InputError({"bench", 0, 0}, "unknown part '" + name + "'; known: " + list);
}

std::vector<BenchRow> measure(const BenchOptions& options) {
  const BenchPart& part = part_of(options.part);
  Progress progress("bench " + options.part, {0.0, "repetitions"});
  BenchSetting setting = options.setting;
  if (setting.library.empty()) setting.library = library_folder();
  if (setting.library.empty())
    throw EnvironmentError(
        "the scenarios that come with the program are not beside it; name their folder by --library");
  setting.step = [&, done = 0]() mutable { progress.at(done++); };
  return part.measure(setting);
}

int bench(const BenchOptions& options) {
  const std::vector<BenchRow> rows = measure(options);
  const std::string text = options.json ? write_json(bench_json(rows)) + "\n" : bench_text(rows);
  std::fwrite(text.data(), 1, text.size(), stdout);
  const bool passed = std::all_of(rows.begin(), rows.end(),
                                  [](const BenchRow& row) { return !row.limit || !row.limit->gates || row.passed(); });
  return passed ? 0 : 1;
}

}  // namespace

Command add_bench(CommandLine& program) {
  const auto options = std::make_shared<BenchOptions>();
  CommandLine line = program.add_command("bench", "Measures the CPU time of a part of the program");
  std::string parts;
  std::string names;
  for (const BenchPart& part : bench_parts()) {
    parts += "\n  " + std::string(part.name) + ": " + std::string(part.summary);
    names += (names.empty() ? "" : ",") + std::string(part.name);
  }
  line.option("PART", options->part, "one of:" + parts).takes("{" + names + "}").required();
  line.flag("--json", options->json, "as JSON");
  line.option("--repetitions", options->setting.repetitions, "of each figure; the median counts")
      .range(1, 1000)
      .shows_default();
  line.option("--library", options->setting.library,
              "folder with quickstart.yaml and s_graphs/long.yaml [that of the program]")
      .takes("DIR");
  line.option("--data", options->setting.data_dir, "folder with ifc/duplex.ifc")
      .takes("DIR")
      .environment("PLUMBLINE_DATA");
  line.footer("Example: plumbline bench bim --json\nExit code 1 when a ratio misses its gate; times are targets.");
  return {line, [options] { return bench(*options); }};
}

}  // namespace plumbline::scenarios
