// SPDX-License-Identifier: Apache-2.0
#include "scenarios/compare/compared_folder.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "bim/config/input_file.h"
#include "bim/config/tree.h"
#include "bim/digest/digest.h"
#include "bim/errors.h"
#include "scenarios/host/manifest.h"
#include "scenarios/metrics/metrics.h"
#include "scenarios/run/digest_log.h"
#include "scenarios/spec/method_names.h"

namespace plumbline::scenarios {

namespace fs = std::filesystem;

namespace {

struct CsvLine {
  std::vector<std::string> cells;
  int number = 0;  ///< in the file, from 1
};

/// Lines of comma-separated cells, quoted where they hold a comma, a quote or a line break.
std::vector<CsvLine> read_csv(std::string_view text, const std::string& file) {
  std::vector<CsvLine> lines;
  int number = 1;
  for (std::size_t at = 0; at < text.size();) {
    CsvLine line{{""}, number};
    bool quoted = false;
    for (; at < text.size() && (quoted || text[at] != '\n'); ++at) {
      const char c = text[at];
      if (c == '\n') ++number;
      if (c == '"' && quoted && at + 1 < text.size() && text[at + 1] == '"')
        line.cells.back() += text[++at];
      else if (c == '"')
        quoted = !quoted;
      else if (c == ',' && !quoted)
        line.cells.emplace_back();
      else
        line.cells.back() += c;
    }
    if (at == text.size()) throw InputError({file, line.number, 1}, "the file ends in the middle of a line");
    ++at;
    ++number;
    lines.push_back(std::move(line));
  }
  return lines;
}

std::optional<double> number_in(const std::string& cell, const Mark& mark) {
  if (cell.empty()) return std::nullopt;
  double value = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size())
    throw InputError(mark, "'" + cell + "' must be a number");
  return value;
}

constexpr const char* what_to_name = "name a run directory (results.json) or the folder of a sweep (runs.csv)";

std::vector<SweepRow> rows_of_run(const std::string& path) {
  const std::string file = path + "/results.json", digests_file = path + "/digests.csv";
  const Tree result = read_json(read_text_file(file), file);
  if (!result.is_map() || result.find("methods") == nullptr || result.find("scenario") == nullptr)
    throw InputError({file, 0, 0}, std::string("is not that of a run; ") + what_to_name);
  std::vector<SweepRow> rows = rows_of(result, file);
  std::map<std::string, std::uint64_t> digests;
  if (fs::exists(digests_file)) digests = digests_by_part(read_digests(read_text_file(digests_file), digests_file));
  const auto digest_of_part = [&](const std::string& part) {
    const auto found = digests.find(part);
    return found == digests.end() ? std::string() : hex64(found->second);
  };
  const Tree* failure = result.find("failure");
  for (SweepRow& row : rows) {
    row.sensor_digest = digest_of_part(std::string(sensor_part));
    row.method_digest = digest_of_part(row.method);
    if (failure == nullptr) continue;
    row.verdict = "failed";
    row.failure = failure->as_string();
    std::fill(row.values.begin(), row.values.end(), std::nullopt);
  }
  return rows;
}

std::vector<std::string> altered_notes(const std::string& path) {
  if (!fs::exists(path + "/" + std::string(manifest_name))) return {};
  std::vector<std::string> notes;
  for (const std::string& name : altered_files(path, {{}, false}))
    if (name == "results.json" || name == "digests.csv")
      notes.push_back(path + ": " + name + " was altered since it was written");
  return notes;
}

using RunKey = std::tuple<std::string, std::string, std::string, std::string>;

/// A sweep with more results than its tables show was stopped, or has fewer seeds now.
std::vector<std::string> notes_on_results(const std::string& path, const std::vector<SweepRow>& rows) {
  std::set<RunKey> runs;
  for (const SweepRow& row : rows) runs.emplace(row.scenario, row.variant, row.start, row.seed);
  std::size_t results = 0;
  std::error_code error;
  for (fs::directory_iterator it(path + "/results", error), end; !error && it != end; it.increment(error))
    if (it->path().extension() == ".json") ++results;
  if (results <= runs.size()) return {};
  return {path + ": results/ holds " + std::to_string(results) + " runs, runs.csv " + std::to_string(runs.size()) +
          "; those of runs.csv are compared; the sweep's command makes its tables anew"};
}

}  // namespace

std::vector<SweepRow> read_runs_csv(std::string_view text, const std::string& file) {
  const std::vector<CsvLine> lines = read_csv(text, file);
  std::map<std::string, std::size_t> columns;
  if (!lines.empty())
    for (std::size_t i = 0; i < lines.front().cells.size(); ++i) columns.emplace(lines.front().cells[i], i);
  for (const char* name : {"scenario", "variant", "start", "seed", "method", "verdict", "digest"})
    if (!columns.contains(name))
      throw InputError({file, 1, 1}, "has no column '" + std::string(name) + "'; runs.csv of a sweep has");
  std::vector<SweepRow> rows;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const CsvLine& line = lines[i];
    const Mark mark{file, line.number, 1};
    if (line.cells.size() != columns.size())
      throw InputError(
          mark, "has " + std::to_string(line.cells.size()) + " cells; the head has " + std::to_string(columns.size()));
    const auto cell = [&](const std::string& name) -> std::string {
      const auto column = columns.find(name);
      return column == columns.end() ? "" : line.cells[column->second];
    };
    SweepRow row;
    row.scenario = cell("scenario");
    row.variant = cell("variant");
    row.start = cell("start");
    row.seed = cell("seed");
    row.method = cell("method");
    row.verdict = cell("verdict");
    row.digest = cell("digest");
    row.evidence = cell("evidence");
    row.failure = cell("failure");
    row.sensor_digest = cell("sensor_digest");
    row.method_digest = cell("method_digest");
    if (!cell("identifiable").empty()) row.identifiable = cell("identifiable") == "true";
    for (const score::MetricRow& metric : score::metrics())
      row.values.push_back(number_in(cell(std::string(metric.name)), mark));
    rows.push_back(std::move(row));
  }
  return rows;
}

ComparedFolder read_compared_folder(const std::string& path) {
  if (!fs::exists(path)) throw InputError({path, 0, 0}, std::string("is not there; ") + what_to_name);
  if (!fs::is_directory(path)) throw InputError({path, 0, 0}, std::string("is a file; ") + what_to_name);
  ComparedFolder folder;
  const std::string runs = path + "/runs.csv";
  if (fs::exists(path + "/results.json")) {
    folder.rows = rows_of_run(path);
    folder.notes = altered_notes(path);
  } else if (fs::is_directory(path + "/.work") || (fs::is_directory(path + "/results") && !fs::exists(runs))) {
    throw InputError({path, 0, 0},
                     "holds an unfinished sweep; run the sweep's command again, it goes on, or collect its shards");
  } else if (fs::exists(runs)) {
    folder.is_sweep = true;
    folder.rows = read_runs_csv(read_text_file(runs), runs);
    folder.notes = notes_on_results(path, folder.rows);
  } else if (fs::exists(path + "/.partial")) {
    throw InputError({path, 0, 0}, "holds an unfinished run; run it again");
  } else {
    throw InputError({path, 0, 0}, std::string("holds neither a run nor a sweep; ") + what_to_name);
  }
  std::erase_if(folder.rows, [](const SweepRow& row) { return row.method == truth_method; });
  if (folder.rows.empty()) throw InputError({path, 0, 0}, "holds no run of a method");
  return folder;
}

}  // namespace plumbline::scenarios
