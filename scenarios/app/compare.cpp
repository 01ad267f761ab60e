// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bim/config/tree.h"
#include "bim/errors.h"
#include "scenarios/app/commands.h"
#include "scenarios/app/process.h"
#include "scenarios/compare/compared_builds.h"
#include "scenarios/compare/compared_folder.h"
#include "scenarios/compare/comparison.h"
#include "scenarios/compare/comparison_text.h"
#include "scenarios/host/interrupt.h"
#include "scenarios/host/terminal.h"
#include "scenarios/metrics/metrics.h"

namespace plumbline::scenarios {

namespace {

struct CompareArguments {
  std::string a, b;
  std::vector<std::string> metrics;
  std::string on, out;
  int seeds = 0, jobs = 0;
  std::string fail_on = "worse";
  bool json = false;
};

/// The metrics that were named, or the usual ones.
std::vector<std::string> asked_metrics(const std::vector<std::string>& named) {
  if (named.empty()) return {compared_metrics().begin(), compared_metrics().end()};
  std::vector<std::string> metrics;
  for (const std::string& name : named) {
    const score::MetricRow* row = score::find_metric(name);
    if (row == nullptr) {
      std::vector<std::string> known;
      for (const score::MetricRow& metric : score::metrics()) known.emplace_back(metric.name);
      const std::string near = did_you_mean(name, known);
      throw InputError({"--metric", 0, 0}, "'" + name + "' is no metric; " +
                                               (near.empty() ? "as in results.json: ate_aligned_rmse_m, rooms.recall"
                                                             : "did you mean '" + near + "'?"));
    }
    if (row->better == score::Better::neither)
      throw InputError({"--metric", 0, 0}, "'" + name + "' is better neither lower nor higher; name one that is");
    if (std::find(metrics.begin(), metrics.end(), name) == metrics.end()) metrics.push_back(name);
  }
  return metrics;
}

const char* kind_of(const ComparedFolder& folder) { return folder.is_sweep ? "a sweep" : "a run"; }

PairedRows paired(const CompareArguments& options, const ComparedFolder& a, const ComparedFolder& b) {
  if (a.is_sweep != b.is_sweep)
    throw InputError({options.b, 0, 0}, std::string("is ") + kind_of(b) + " and " + options.a + " " + kind_of(a) +
                                            "; name two of one kind");
  PairedRows rows = pair_rows(a.rows, b.rows);
  if (!rows.pairs.empty()) return rows;
  const SweepRow &first = a.rows.front(), &other = b.rows.front();
  throw InputError({options.b, 0, 0},
                   "has no run of " + options.a +
                       " with the same scenario, variant, start, seed and method; the first there is " +
                       run_title(first) + ", " + first.method + ", and here " + run_title(other) + ", " + other.method);
}

/// A metric that was asked for by name and that nothing has would pass unseen.
void check_measured(const PairedRows& rows, const std::vector<std::string>& named) {
  for (const std::string& name : named) {
    const auto at = static_cast<std::size_t>(score::find_metric(name) - score::metrics().data());
    if (std::none_of(rows.pairs.begin(), rows.pairs.end(),
                     [&](const RowPair& pair) { return pair.a.values[at] || pair.b.values[at]; }))
      throw InputError({"--metric", 0, 0}, "no run of a pair has '" + name + "'; name a metric of these methods");
  }
}

bool fails(const Comparison& comparison, const std::string& fail_on) {
  if (fail_on == "never") return false;
  const bool worse = comparison.finding == Finding::worse || comparison.finding == Finding::mixed;
  if (worse || !comparison.failures_b.empty()) return true;
  return fail_on == "different" &&
         (comparison.finding != Finding::same || !comparison.only_a.empty() || !comparison.only_b.empty());
}

/// The folders to compare: those that are named, or those that two programs make.
std::pair<std::string, std::string> folders(const CompareArguments& options) {
  if (options.on.empty()) {
    for (const std::string& name : {options.a, options.b})
      if (is_program(name))
        throw InputError({name, 0, 0}, "is a program; name by --on the sweep that both are to run, and by -o a folder");
    return {options.a, options.b};
  }
  if (options.out.empty()) throw InputError({"--on", 0, 0}, "needs -o: the folder of both sweeps");
  for (const std::string& name : {options.a, options.b})
    if (!is_program(name)) throw InputError({name, 0, 0}, "is no program; with --on name two plumbline programs");
  catch_interrupts();
  return sweep_with_both(
      {options.a, options.b, options.on, options.out, options.seeds, options.jobs > 0 ? options.jobs : allowed_cpus()});
}

int compare(const CompareArguments& options) {
  const std::vector<std::string> metrics = asked_metrics(options.metrics);
  const auto [folder_a, folder_b] = folders(options);
  const ComparedFolder a = read_compared_folder(folder_a), b = read_compared_folder(folder_b);
  const PairedRows rows = paired(options, a, b);
  check_measured(rows, options.metrics);
  for (const ComparedFolder* folder : {&a, &b})
    for (const std::string& note : folder->notes) print_note("plumbline: warning: " + note);
  const Comparison comparison = compare_rows(rows, metrics);
  const ComparedNames names{options.a, options.b};
  print(options.json ? write_json(comparison_results(comparison, names)) + "\n" : comparison_text(comparison, names));
  return fails(comparison, options.fail_on) ? 1 : 0;
}

}  // namespace

Command add_compare(CommandLine& program) {
  const auto options = std::make_shared<CompareArguments>();
  CommandLine line = program.add_command("compare", "Says whether B is better or worse than A, run by run");
  line.option("A", options->a, "before: run directory, folder of a sweep, or with --on a plumbline program")
      .takes("DIR")
      .required();
  line.option("B", options->b, "after: the same of what is to be judged").takes("DIR").required();
  line.option("--metric", options->metrics, "metric to compare, in place of the usual ones; may be repeated")
      .takes("METRIC")
      .delimiter(',');
  line.option("--fail-on", options->fail_on,
              "what makes the exit code 1: worse, also a wrong answer, crash or failed walk in B alone; "
              "different, anything that is not the same; or never")
      .one_of({"worse", "different", "never"})
      .shows_default();
  const Argument on =
      line.option("--on", options->on, "sweep file that the programs A and B run, into OUT/a and OUT/b").takes("SWEEP");
  line.option("-o,--out", options->out, "with --on: folder of both sweeps, new or to be resumed")
      .takes("DIR")
      .needs(on);
  line.option("--seeds", options->seeds, "with --on: number of seeds, in place of the file's")
      .range(1, 100000)
      .needs(on);
  line.option("--jobs", options->jobs, "with --on: runs at a time [the CPUs allowed]").range(1, 1024).needs(on);
  line.flag("--json", options->json, "prints all numbers as JSON");
  line.footer(
      "Runs are paired by scenario, variant, start, seed and method.\n"
      "Example: plumbline compare sweeps/before sweeps/after\n"
      "         plumbline compare runs/before runs/after --metric map_rmse_m,walls.recall --fail-on different\n"
      "         plumbline compare old/plumbline new/plumbline --on look.yaml -o sweeps/change\n"
      "Exit code 1 when B is worse");
  return {line, [options] { return compare(*options); }};
}

}  // namespace plumbline::scenarios
