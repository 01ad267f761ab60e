// SPDX-License-Identifier: Apache-2.0
#include "scenarios/sweep/table.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <set>
#include <string_view>

#include "bim/config/printable.h"
#include "bim/median.h"
#include "scenarios/metrics/metrics.h"
#include "scenarios/report/svg.h"
#include "scenarios/run/digest_log.h"
#include "scenarios/score/walk_end.h"

namespace plumbline::scenarios {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

const Tree* find_path(const Tree& tree, std::string_view path) {
  const std::size_t dot = path.find('.');
  const Tree* child = tree.is_map() ? tree.find(path.substr(0, dot)) : nullptr;
  return child == nullptr || dot == std::string_view::npos ? child : find_path(*child, path.substr(dot + 1));
}

std::string text_at(const Tree& tree, std::string_view key) {
  const Tree* value = tree.find(key);
  return value == nullptr ? "" : value->as_string();
}

std::size_t metric_index(std::string_view name) {
  const auto rows = score::metrics();
  const auto it = std::find_if(rows.begin(), rows.end(), [&](const score::MetricRow& row) { return row.name == name; });
  return static_cast<std::size_t>(it - rows.begin());
}

/// Median where absent values count as infinite; absent when it is.
std::optional<double> finite_median(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  const double middle = median(values);
  return std::isfinite(middle) ? std::optional(middle) : std::nullopt;
}

/// What the medians of a cell are taken over.
struct Samples {
  std::vector<double> identifiable_at_s, identifiable_at_m, converged_at_m, error_m;
};

/// Whether a walk's scans leave one pose is known from any of its localizations, one that crashed has its own not.
void complete_by_walk(std::vector<SweepRow>& rows) {
  std::map<std::array<std::string, 4>, const SweepRow*> known;
  const auto walk_of = [](const SweepRow& row) {
    return std::array<std::string, 4>{row.scenario, row.variant, row.start, row.seed};
  };
  std::set<std::array<std::string, 4>> localizers;
  for (const SweepRow& row : rows) {
    if (!row.identifiable) continue;
    known.try_emplace(walk_of(row), &row);
    localizers.insert({row.scenario, row.variant, row.start, row.method});
  }
  for (SweepRow& row : rows) {
    const auto it = known.find(walk_of(row));
    if (row.identifiable || it == known.end() ||
        !localizers.contains({row.scenario, row.variant, row.start, row.method}))
      continue;
    row.identifiable = it->second->identifiable;
    row.evidence = it->second->evidence;
  }
}

void count(const SweepRow& row, SweepCell& cell, Samples& samples) {
  static const std::size_t at_s = metric_index("localization.identifiable_at_s");
  static const std::size_t at_m = metric_index("localization.identifiable_at_m");
  static const std::size_t converged_m = metric_index("localization.converged_at_m");
  static const std::size_t ape = metric_index("localization.ape_rmse_m");
  static const std::size_t ate = metric_index("ate_aligned_rmse_m");
  ++cell.runs;
  ++cell.verdicts[row.verdict];
  if (row.verdict == "failed") {
    ++cell.failed;
    return;
  }
  if (row.identifiable) cell.localizes = true;
  const std::optional<double> error = row.values[cell.localizes ? ape : ate];
  if (row.verdict == "false_convergence" || row.verdict == "overconfident") ++cell.false_convergences;
  if (row.evidence == "weak") {
    ++cell.marginal;
    if (row.verdict == "success" || row.verdict == "honest_ambiguity") ++cell.marginal_right;
  } else if (row.identifiable.value_or(true)) {
    ++cell.judged;
    samples.error_m.push_back(error.value_or(infinite));
    if (row.verdict == "success" || row.verdict == "complete") ++cell.succeeded;
    const bool found = row.verdict == "success";
    samples.converged_at_m.push_back(found ? row.values[converged_m].value_or(infinite) : infinite);
    if (row.values[at_s]) samples.identifiable_at_s.push_back(*row.values[at_s]);
    if (row.values[at_m]) samples.identifiable_at_m.push_back(*row.values[at_m]);
  } else {
    ++cell.ambiguous;
    if (row.verdict == "honest_ambiguity") ++cell.honest;
  }
}

void conclude(const Samples& samples, SweepCell& cell) {
  if (cell.localizes) cell.median_converged_at_m = finite_median(samples.converged_at_m);
  cell.median_identifiable_at_s = finite_median(samples.identifiable_at_s);
  cell.median_identifiable_at_m = finite_median(samples.identifiable_at_m);
  cell.median_error_m = finite_median(samples.error_m);
}

std::string percent(double share) { return svg::number(100.0 * share, 0); }

/// Neither all nor none where it is not.
std::string percent(int k, int n) {
  const double share = 100.0 * k / n;
  return k > 0 && share < 1.0 ? svg::number(std::max(share, 0.1), 1)
                              : svg::number(k < n ? std::min(share, 99.0) : share, 0);
}

/// "96 % [80, 99]"
std::string share_text(int k, int n) {
  if (n == 0) return "-";
  const auto [low, high] = wilson95(k, n);
  return percent(k, n) + " % [" + percent(low) + ", " + percent(high) + "]";
}

/// "3/4"
std::string count_text(int k, int n) { return n == 0 ? "-" : std::to_string(k) + "/" + std::to_string(n); }

std::string optional_text(const std::optional<double>& value, int decimals) {
  return value ? svg::number(*value, decimals) : "-";
}

std::string verdict_list(const SweepCell& cell) {
  std::string list;
  for (const auto& [verdict, n] : cell.verdicts) list += (list.empty() ? "" : " ") + verdict + ":" + std::to_string(n);
  return list;
}

using Line = std::vector<std::string>;

/// A word that a spreadsheet would take for a formula gets an apostrophe before it; a number and "-" stay.
std::string no_formula(const std::string& text) {
  if (text.empty() || text == "-" || std::string_view("=+-@\t\r").find(text.front()) == std::string_view::npos)
    return text;
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_number = error == std::errc() && end == text.data() + text.size();
  return is_number ? text : "'" + text;
}

std::string csv(const std::string& cell) {
  const std::string text = no_formula(cell);
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

std::string csv_line(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) text += (i == 0 ? "" : ",") + csv(words[i]);
  return text + "\n";
}

std::pair<double, double> wilson95(int k, int n) {
  if (n <= 0) return {0.0, 1.0};
  constexpr double z = 1.959963984540054;
  const double p = static_cast<double>(k) / n;
  const double zz = z * z / n;
  const double middle = (p + 0.5 * zz) / (1.0 + zz);
  const double half = z * std::sqrt(p * (1.0 - p) / n + 0.25 * zz / n) / (1.0 + zz);
  return {std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

std::vector<SweepRow> rows_of(const Tree& result, const std::string& file) {
  SweepRow common;
  common.scenario = text_at(result, "scenario");
  common.variant = text_at(result, "variant");
  common.start = text_at(result, "start");
  common.seed = text_at(result, "seed");
  common.digest = text_at(result, "digest");
  common.failure = text_at(result, "failure");
  const Tree* digests = result.find("digests");
  if (digests != nullptr) common.sensor_digest = text_at(*digests, sensor_part);
  common.values.resize(score::metrics().size());
  if (const Tree* warnings = result.find("warnings"))
    for (const Tree& warning : warnings->as_list()) common.warnings.push_back(warning.as_string());
  const Tree* methods = result.find("methods");
  if (methods == nullptr) throw InputError({file, 0, 0}, "has no methods; remove it, so that it is made again");
  std::vector<SweepRow> rows;
  for (const auto& [name, scores] : methods->as_map()) {
    SweepRow row = common;
    row.method = name;
    row.verdict = text_at(scores, "verdict");
    if (digests != nullptr) row.method_digest = text_at(*digests, name);
    if (const Tree* known = find_path(scores, "localization.identifiable")) row.identifiable = known->as_bool();
    if (const Tree* evidence = find_path(scores, "localization.evidence")) row.evidence = evidence->as_string();
    if (const Tree* failure = find_path(scores, "localization.failure")) row.failure = failure->as_string();
    for (std::size_t i = 0; i < row.values.size(); ++i)
      if (const Tree* value = find_path(scores, score::metrics()[i].name)) row.values[i] = value->as_double();
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string walks_title(const SweepRow& row) {
  std::string title = row.scenario;
  for (const std::string& part : {row.variant, row.start})
    if (!part.empty()) title += ", " + part;
  return title;
}

std::vector<std::string> walk_notes(const std::vector<SweepRow>& rows) {
  struct Walks {
    std::string title;
    std::set<std::string> all, failed, cut_short, warned;
    std::string first_failure, first_cut, first_warning;
  };
  std::vector<Walks> groups;
  for (const SweepRow& row : rows) {
    const std::string title = walks_title(row);
    auto walks = std::find_if(groups.begin(), groups.end(), [&](const Walks& one) { return one.title == title; });
    if (walks == groups.end()) walks = groups.insert(groups.end(), Walks{title, {}, {}, {}, {}, {}, {}, {}});
    walks->all.insert(row.seed);
    if (row.verdict == "failed" && walks->failed.insert(row.seed).second && walks->first_failure.empty())
      walks->first_failure = row.failure;
    for (const std::string& warning : row.warnings) {
      const bool is_cut = warning.starts_with(score::cut_short_mark);
      std::string& first = is_cut ? walks->first_cut : walks->first_warning;
      (is_cut ? walks->cut_short : walks->warned).insert(row.seed);
      if (first.empty()) first = warning;
    }
  }
  std::vector<std::string> notes;
  const auto note = [&](const Walks& walks, std::size_t count, const char* what, const std::string& first) {
    if (count == 0) return;
    notes.push_back(walks.title + ": " + std::to_string(count) + " of " + std::to_string(walks.all.size()) +
                    (walks.all.size() == 1 ? " walk " : " walks ") + what + (count == 1 ? "" : ", the first") + ": " +
                    first);
  };
  for (const Walks& walks : groups) {
    note(walks, walks.failed.size(), "failed", walks.first_failure);
    note(walks, walks.cut_short.size(), "cut short", walks.first_cut);
    note(walks, walks.warned.size(), "with a warning", walks.first_warning);
  }
  return notes;
}

bool is_refused(const SweepRow& row) { return row.failure.starts_with(refused_mark); }

std::string refused_in(const std::vector<SweepRow>& rows) {
  std::set<std::string> keys, refused;
  std::string first;
  for (const SweepRow& row : rows) {
    keys.insert(row.key);
    if (is_refused(row) && refused.insert(row.key).second && first.empty())
      first = row.key + ": " + row.failure.substr(refused_mark.size());
  }
  if (refused.empty()) return "";
  return std::to_string(refused.size()) + " of " + std::to_string(keys.size()) + " runs cannot be made; " + first;
}

std::string broken_in(const std::vector<SweepRow>& rows) {
  std::set<std::string> keys, broken;
  std::string first;
  for (const SweepRow& row : rows) {
    keys.insert(row.key);
    const bool broke = row.failure.starts_with(died_mark) || row.failure.starts_with(internal_error_mark);
    if (broke && broken.insert(row.key).second && first.empty()) first = row.key + ": " + row.failure;
  }
  if (broken.empty()) return "";
  return std::to_string(broken.size()) + " of " + std::to_string(keys.size()) + " runs broke the program; " + first;
}

std::optional<double> error_of(const SweepRow& row) {
  static const std::size_t ape = metric_index("localization.ape_rmse_m");
  static const std::size_t ate = metric_index("ate_aligned_rmse_m");
  return row.values[row.identifiable ? ape : ate];
}

std::vector<SweepCell> cells_of(std::vector<SweepRow> rows) {
  complete_by_walk(rows);
  std::vector<SweepCell> cells;
  std::vector<Samples> samples;
  for (const SweepRow& row : rows) {
    auto it = std::find_if(cells.begin(), cells.end(), [&](const SweepCell& c) {
      return c.scenario == row.scenario && c.variant == row.variant && c.start == row.start && c.method == row.method;
    });
    if (it == cells.end()) {
      SweepCell fresh;
      fresh.scenario = row.scenario;
      fresh.variant = row.variant;
      fresh.start = row.start;
      fresh.method = row.method;
      it = cells.insert(cells.end(), std::move(fresh));
      samples.emplace_back();
    }
    count(row, *it, samples[static_cast<std::size_t>(it - cells.begin())]);
  }
  for (std::size_t i = 0; i < cells.size(); ++i) conclude(samples[i], cells[i]);
  return cells;
}

std::string runs_csv(const std::vector<SweepRow>& rows) {
  Line head = {"scenario", "variant",      "start",    "seed",    "method",        "verdict",
               "digest",   "identifiable", "evidence", "failure", "sensor_digest", "method_digest"};
  for (const score::MetricRow& metric : score::metrics()) head.emplace_back(metric.name);
  std::string text = csv_line(head);
  for (const SweepRow& row : rows) {
    Line line = {
        row.scenario, row.variant, row.start,         row.seed,
        row.method,   row.verdict, row.digest,        row.identifiable ? (*row.identifiable ? "true" : "false") : "",
        row.evidence, row.failure, row.sensor_digest, row.method_digest};
    for (const auto& value : row.values) line.push_back(value ? format_number(*value) : "");
    text += csv_line(line);
  }
  return text;
}

std::vector<Line> table_lines(const std::vector<SweepCell>& cells) {
  std::vector<Line> lines = {{"scenario", "variant", "start", "method", "runs", "identifiable", "success", "honest",
                              "marginal", "wrong", "identifiable at s", "identifiable at m", "converged at m",
                              "error m", "verdicts"}};
  for (const SweepCell& c : cells)
    lines.push_back(
        {c.scenario, c.variant.empty() ? "-" : c.variant, c.start.empty() ? "-" : c.start, c.method,
         std::to_string(c.runs), c.localizes ? std::to_string(c.judged) : "-", share_text(c.succeeded, c.judged),
         share_text(c.honest, c.ambiguous), count_text(c.marginal_right, c.marginal),
         std::to_string(c.false_convergences), optional_text(c.median_identifiable_at_s, 1),
         optional_text(c.median_identifiable_at_m, 1),
         c.localizes && c.judged > 0 && !c.median_converged_at_m ? "never" : optional_text(c.median_converged_at_m, 1),
         c.judged > 0 && !c.median_error_m ? "none" : optional_text(c.median_error_m, 3), verdict_list(c)});
  return lines;
}

std::string table_text(const std::vector<SweepCell>& cells) {
  std::vector<Line> lines = table_lines(cells);
  for (Line& line : lines)
    for (std::string& text : line) text = printable(text);
  std::vector<std::size_t> width(lines.front().size(), 0);
  for (const Line& line : lines)
    for (std::size_t i = 0; i < line.size(); ++i) width[i] = std::max(width[i], line[i].size());
  std::string text;
  for (const Line& line : lines) {
    std::string row;
    for (std::size_t i = 0; i < line.size(); ++i) row += line[i] + std::string(width[i] - line[i].size() + 2, ' ');
    row.erase(row.find_last_not_of(' ') + 1);
    text += row + "\n";
  }
  return text;
}

std::string table_csv(const std::vector<SweepCell>& cells) {
  std::string text;
  for (const Line& line : table_lines(cells)) text += csv_line(line);
  return text;
}

}  // namespace plumbline::scenarios
