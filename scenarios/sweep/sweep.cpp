// SPDX-License-Identifier: Apache-2.0
#include "scenarios/sweep/sweep.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include "bim/config/printable.h"
#include "bim/errors.h"
#include "scenarios/host/files.h"
#include "scenarios/host/interrupt.h"
#include "scenarios/sweep/children.h"
#include "scenarios/sweep/sweep_folder.h"
#include "scenarios/sweep/table_page.h"

namespace plumbline::scenarios {

namespace fs = std::filesystem;

namespace {

/// Another sweep's tables would be replaced. One that has grown has some of its runs there.
void check_no_other_sweep(const Sweep& sweep, const std::string& out) {
  std::error_code error;
  bool any = false;
  for (fs::directory_iterator it(out + "/results", error), end; !error && it != end; it.increment(error)) {
    if (it->path().extension() != ".json") continue;
    const std::string key = it->path().stem().string();
    if (std::any_of(sweep.runs.begin(), sweep.runs.end(), [&](const SweepRun& run) { return run.key == key; })) return;
    any = true;
  }
  if (any) throw InputError({out, 0, 0}, "holds the results of another sweep; name another --out");
}

/// Whether the result there says that the run was refused: what was in the way may be gone, as with a newer program.
bool is_refused(const std::string& path) {
  const Tree result = read_json(read_text_file(path), path);
  const Tree* failure = result.is_map() ? result.find("failure") : nullptr;
  return failure != nullptr && failure->as_string().starts_with(refused_mark);
}

bool is_made(const std::string& path, const SweepRun& run) {
  if (!fs::exists(path)) return false;
  try {
    const Tree* input = nullptr;
    const Tree result = read_json(read_text_file(path), path);
    input = result.is_map() ? result.find("input") : nullptr;
    return input != nullptr && input->as_string() == run.input_digest;
  } catch (const InputError&) {
    return false;
  }
}

/// What is kept of a run. `results`: its results.json, or nothing where the scenario failed; `digests`: of its parts.
Tree result_of(const SweepRun& run, const std::optional<Tree>& results, const std::optional<Tree>& digests,
               const std::vector<std::string>& methods, const std::string& failure) {
  Tree tree = Tree::map();
  tree.set("input", run.input_digest).set("scenario", run.scenario).set("variant", run.variant).set("start", run.start);
  tree.set("seed", std::to_string(run.seed));
  if (results && results->find("failure") == nullptr) {
    tree.set("digest", *results->find("digest"));
    if (digests) tree.set("digests", *digests);
    tree.set("duration_s", *results->find("duration_s")).set("distance_m", *results->find("distance_m"));
    tree.set("methods", *results->find("methods"));
    const Tree* walk = results->find("walk");
    const Tree* warnings = walk == nullptr ? nullptr : walk->find("warnings");
    if (warnings != nullptr) tree.set("warnings", *warnings);
    return tree;
  }
  Tree failed = Tree::map();
  for (const std::string& method : methods) failed.set(method, Tree::map().set("verdict", "failed"));
  return tree.set("failure", failure).set("methods", failed);
}

std::vector<std::string> methods_of(const Sweep& sweep, const SweepRun& run) {
  std::vector<std::string> methods = read_scenario(sweep.scenario_texts[run.text], run.scenario).scenario.methods;
  if (methods.empty()) methods.emplace_back("all");
  return methods;
}

/// A run whose scenario the program does not take, and why.
struct Refusal {
  const SweepRun* run;
  std::string reason;
};

InputError error_of(const Refusal& refusal) {
  const SweepRun& run = *refusal.run;
  return {{run.scenario, 0, 0},
          (run.variant.empty() ? "" : "'" + run.variant + "', ") +
              (run.start.empty() ? "" : "start " + run.start + ", ") + "seed " + std::to_string(run.seed) + ": " +
              refusal.reason};
}

/// Why a run failed.
std::string failure_of(const ChildEnd& end) {
  constexpr int first_signal = 128;
  if (end.code <= first_signal) return end.last_line;
  return std::string(died_mark) + std::to_string(end.code - first_signal);
}

/// A run that breaks the program would break it again whenever the sweep goes on: it has failed, and the others stand.
void keep(const Sweep& sweep, const SweepFolder& folder, const SweepRun& run, const ChildEnd& end) {
  constexpr int scenario_failed = 4;
  if (end.code != 0 && end.code != 1 && end.code != scenario_failed && !broke(end))
    throw EnvironmentError("sweep: run " + run.key + " ended with " + std::to_string(end.code) + ": " + end.last_line);
  const auto left = [&](const char* name) -> std::optional<Tree> {
    const std::string file = folder.work() + "/" + run.key + "/" + name;
    return fs::exists(file) && !broke(end) ? std::optional(read_json(read_text_file(file), file)) : std::nullopt;
  };
  const Tree result =
      result_of(run, left("results.json"), left("digests.json"), methods_of(sweep, run), failure_of(end));
  write_file(folder.result(run), write_json(result) + "\n");
  std::error_code error;
  fs::remove_all(folder.work() + "/" + run.key, error);
}

/// The others' results stand; where there is no other, the first refusal is the answer to the whole sweep.
void keep_refusals(const Sweep& sweep, const SweepFolder& folder, const std::vector<Refusal>& refusals) {
  if (!refusals.empty() && refusals.size() == sweep.runs.size()) throw error_of(refusals.front());
  for (const Refusal& refusal : refusals)
    write_file(folder.result(*refusal.run),
               write_json(result_of(*refusal.run, std::nullopt, std::nullopt, methods_of(sweep, *refusal.run),
                                    std::string(refused_mark) + refusal.reason)) +
                   "\n");
}

/// Which walk of the sweep each is, by the digest of its simulation.
std::map<std::string, int> walk_numbers(const Sweep& sweep) {
  std::map<std::string, int> numbers;
  for (const SweepRun& run : sweep.runs) numbers.try_emplace(run.simulation_digest, static_cast<int>(numbers.size()));
  return numbers;
}

/// The runs of a shard, or all.
std::vector<const SweepRun*> runs_of(const Sweep& sweep, const std::optional<Shard>& shard) {
  const std::map<std::string, int> numbers = walk_numbers(sweep);
  std::vector<const SweepRun*> runs;
  for (const SweepRun& run : sweep.runs)
    if (!shard || numbers.at(run.simulation_digest) % shard->of == shard->number - 1) runs.push_back(&run);
  return runs;
}

using Group = std::vector<const SweepRun*>;

/// The runs that are not made yet, those of one walk together, by the first of each.
std::vector<Group> missing_groups(const std::vector<const SweepRun*>& runs, const SweepFolder& folder) {
  constexpr std::size_t most_at_once = 32;  // their methods stand in memory side by side
  std::vector<Group> groups;
  std::map<std::string, std::size_t> group_of;
  for (const SweepRun* run : runs) {
    if (is_made(folder.result(*run), *run) && !is_refused(folder.result(*run))) continue;
    const auto [it, fresh] = group_of.try_emplace(run->simulation_digest, groups.size());
    if (!fresh && groups[it->second].size() >= most_at_once) it->second = groups.size();
    if (it->second == groups.size()) groups.emplace_back();
    groups[it->second].push_back(run);
  }
  return groups;
}

/// Makes the runs of each group together; gives those that were refused. Of several runs of one walk only one may be at
/// fault: they are made again each for itself.
std::vector<Refusal> make_groups(const Sweep& sweep, const std::vector<Group>& groups, int jobs,
                                 const SweepFolder& folder, const std::function<void(std::size_t)>& made) {
  std::vector<Refusal> refusals;
  std::vector<Group> singles;
  run_children(
      groups.size(), jobs,
      [&](std::size_t i) {
        std::vector<std::string> arguments = {"sweep", "--seed", std::to_string(groups[i].front()->seed), "--runs"};
        for (const SweepRun* run : groups[i]) {
          arguments.push_back(folder.work() + "/" + run->key + ".yaml");
          write_file(arguments.back(), sweep.scenario_texts[run->text]);
        }
        return arguments;
      },
      [&](std::size_t i, const ChildEnd& end) {
        constexpr int bad_input = 2;
        const bool refused = end.code == bad_input, again = (refused || broke(end)) && groups[i].size() > 1;
        for (const SweepRun* run : groups[i]) {
          if (again) singles.push_back({run});
          if (!again && !refused) keep(sweep, folder, *run, end);
        }
        if (again) return;
        if (refused) refusals.push_back({groups[i].front(), without_place(end.last_line, folder.work())});
        made(groups[i].size());
      });
  if (singles.empty()) return refusals;
  for (Refusal& refusal : make_groups(sweep, singles, jobs, folder, made)) refusals.push_back(std::move(refusal));
  return refusals;
}

std::vector<Refusal> make_missing(const Sweep& sweep, const std::vector<const SweepRun*>& runs,
                                  const SweepOptions& options, const SweepFolder& folder) {
  const std::vector<Group> groups = missing_groups(runs, folder);
  std::size_t done = runs.size();
  for (const Group& group : groups) done -= group.size();
  if (done > 0 && options.resumed) options.resumed(done, runs.size());
  std::vector<Refusal> refusals = make_groups(sweep, groups, options.jobs, folder, [&](std::size_t count) {
    done += count;
    if (options.progress) options.progress(done, runs.size());
  });
  keep_refusals(sweep, folder, refusals);
  return refusals;
}

/// The runs whose pages are asked for.
struct PagesAsked {
  std::vector<std::string> keys;  ///< of runs, or "worst"
  int jobs = 1;
};

constexpr std::string_view worst_run = "worst";

const SweepRun& asked_run(const Sweep& sweep, const std::vector<SweepRow>& rows, const std::string& key) {
  const std::vector<const SweepRow*> order = worst_first(rows);
  const auto worst = std::find_if(order.begin(), order.end(), [](const SweepRow* row) { return !is_refused(*row); });
  const std::string wanted = key == worst_run && worst != order.end() ? (*worst)->key : key;
  const auto run =
      std::find_if(sweep.runs.begin(), sweep.runs.end(), [&](const SweepRun& one) { return one.key == wanted; });
  if (run == sweep.runs.end())
    throw InputError({"--page", 0, 0}, "the sweep has no run '" + key + "'; its runs are called like " +
                                           sweep.runs.front().key + ", and 'worst' is the worst one");
  return *run;
}

/// Makes the runs again, each into a directory of its own with its report and its replay page.
void make_pages(const Sweep& sweep, const std::vector<SweepRow>& rows, const SweepFolder& folder,
                const PagesAsked& asked) {
  std::vector<const SweepRun*> runs;
  for (const std::string& key : asked.keys)
    if (const SweepRun* run = &asked_run(sweep, rows, key); std::find(runs.begin(), runs.end(), run) == runs.end())
      runs.push_back(run);
  if (runs.empty()) return;
  (void)make_folders(folder.page(""), folder.page(""));
  run_children(
      runs.size(), asked.jobs,
      [&](std::size_t i) {
        const std::string scenario = folder.work() + "/" + runs[i]->key + ".yaml";
        write_file(scenario, sweep.scenario_texts[runs[i]->text]);
        return std::vector<std::string>{
            "run",     scenario,  "--seed", std::to_string(runs[i]->seed), "--out", folder.page(runs[i]->key),
            "--force", "--replay"};
      },
      [&](std::size_t i, const ChildEnd& end) {
        constexpr int gate_failed = 1, bad_input = 2, scenario_failed = 4;
        if (end.code == bad_input) throw error_of({runs[i], without_place(end.last_line, folder.work())});
        if (end.code != 0 && end.code != gate_failed && end.code != scenario_failed)
          throw EnvironmentError("sweep: page of " + runs[i]->key + " ended with " + std::to_string(end.code) + ": " +
                                 end.last_line);
      });
}

/// Whether a run's page shows what the table says of it; one that was made before the scenario changed does not.
bool is_page_of(const std::string& page, const std::string& result) {
  if (!fs::exists(page + "/report.html") || !fs::exists(page + "/results.json")) return false;
  const auto digest_of = [](const std::string& file) -> std::string {
    const Tree tree = read_json(read_text_file(file), file);
    const Tree* digest = tree.is_map() ? tree.find("digest") : nullptr;
    return digest != nullptr ? digest->as_string() : "";
  };
  return digest_of(page + "/results.json") == digest_of(result);
}

/// The tables of results that are all there.
SweepTables write_tables(const Sweep& sweep, const SweepFolder& folder, const std::string& out,
                         const PagesAsked& asked) {
  std::vector<SweepRow> rows;
  for (const SweepRun& run : sweep.runs) {
    const std::string file = folder.result(run);
    for (SweepRow& row : rows_of(read_json(read_text_file(file), file), file)) {
      row.key = run.key;
      rows.push_back(std::move(row));
    }
  }
  make_pages(sweep, rows, folder, asked);
  SweepPage page{sweep.file.name, sweep.file_name, {}, sweep.seeds};
  for (const SweepRun& run : sweep.runs)
    if (is_page_of(folder.page(run.key), folder.result(run))) page.pages.insert(run.key);
  const std::vector<SweepCell> cells = cells_of(rows);
  const std::string text = table_text(cells);
  write_file(out + "/runs.csv", runs_csv(rows));
  write_file(out + "/table.csv", table_csv(cells));
  write_file(out + "/table.html", table_html(page, rows, cells));
  write_database(out + "/sweep.sqlite", rows, cells);
  std::vector<std::string> notes = walk_notes(rows);
  std::string below = notes.empty() ? "" : "\n";
  for (const std::string& note : notes) below += printable(note) + "\n";
  write_file(out + "/table.txt", text + below);
  return {text, std::move(notes), refused_in(rows), broken_in(rows)};
}

/// The result of a run among those of shards; empty where there is none of this input.
std::string find_result(const SweepRun& run, const std::vector<std::string>& folders) {
  std::string found, from, refused;
  for (const std::string& folder : folders) {
    const std::string path = folder + "/results/" + run.key + ".json";
    if (!is_made(path, run)) continue;
    if (is_refused(path)) {
      refused = read_text_file(path);
      continue;
    }
    std::string text = read_text_file(path);
    if (!found.empty() && text != found) throw InputError({path, 0, 0}, "differs from that in " + from);
    found = std::move(text);
    from = folder;
  }
  return found.empty() ? refused : found;
}

}  // namespace

int walks_of(const Sweep& sweep) { return static_cast<int>(walk_numbers(sweep).size()); }

SweepTables run_sweep(const Sweep& sweep, const SweepOptions& options) {
  for (const std::string& key : options.pages)
    if (key != worst_run) (void)asked_run(sweep, {}, key);  // refused before any run is made
  check_no_other_sweep(sweep, options.out);
  const SweepFolder folder(options.out);
  const std::vector<const SweepRun*> runs = runs_of(sweep, options.shard);
  std::vector<Refusal> refusals;
  try {
    refusals = make_missing(sweep, runs, options, folder);
  } catch (const Interrupted& interrupted) {
    const auto done = std::count_if(runs.begin(), runs.end(),
                                    [&](const SweepRun* run) { return is_made(folder.result(*run), *run); });
    throw Interrupted(interrupted.signal(), std::to_string(done) + " of " + std::to_string(runs.size()) +
                                                " runs are done; the same command goes on");
  }
  if (!options.shard) return write_tables(sweep, folder, options.out, {options.pages, options.jobs});
  return {"shard " + std::to_string(options.shard->number) + " of " + std::to_string(options.shard->of) + ": " +
              std::to_string(runs.size()) + " of " + std::to_string(sweep.runs.size()) + " runs are there\n",
          {},
          refusals.empty() ? ""
                           : std::to_string(refusals.size()) + " of them cannot be made; " + refusals.front().run->key +
                                 ": " + refusals.front().reason};
}

SweepTables collect_sweep(const Sweep& sweep, const std::vector<std::string>& folders, const std::string& out) {
  for (const std::string& folder : folders)
    if (!fs::is_directory(folder + "/results"))
      throw InputError({folder, 0, 0}, "holds no results; name folders that sweep --shard wrote");
  std::vector<std::string> texts;
  std::size_t missing = 0;
  std::string first_missing;
  for (const SweepRun& run : sweep.runs) {
    texts.push_back(find_result(run, folders));
    if (!texts.back().empty()) continue;
    if (missing++ == 0) first_missing = run.key;
  }
  if (missing > 0)
    throw InputError({folders.front(), 0, 0}, "and its like lack " + std::to_string(missing) + " of " +
                                                  std::to_string(sweep.runs.size()) + " runs, the first is " +
                                                  first_missing +
                                                  "; run the shards again, they go on. Results of another build of the "
                                                  "program, or of another scenario, do not count");
  check_no_other_sweep(sweep, out);
  const SweepFolder folder(out);
  for (std::size_t i = 0; i < sweep.runs.size(); ++i)
    if (!is_made(folder.result(sweep.runs[i]), sweep.runs[i])) write_file(folder.result(sweep.runs[i]), texts[i]);
  return write_tables(sweep, folder, out, {});
}

}  // namespace plumbline::scenarios
