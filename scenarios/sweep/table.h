// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bim/config/tree.h"

namespace plumbline::scenarios {

/// Interval [wilson1927] that holds a share with 95 %: of k in n. (0, 1) when n is 0.
[[nodiscard]] std::pair<double, double> wilson95(int k, int n);

/// One method of one run.
struct SweepRow {
  std::string scenario, variant, start, seed, method;
  std::string verdict;  ///< of the method; "failed" where the scenario did
  std::string digest;
  std::optional<bool> identifiable;
  std::string evidence;                       ///< of a localization: unique, weak or ambiguous
  std::string failure;                        ///< why the scenario failed, or else a localization
  std::vector<std::optional<double>> values;  ///< by score::metrics()
  std::string key = {};                       ///< of the run's files
  std::vector<std::string> warnings = {};     ///< of its walk
  std::string sensor_digest = {};             ///< of its sensor data; empty where it is not known
  std::string method_digest = {};             ///< of all stages of the method; empty where it is not known
};

/// Begins the failure of a run whose scenario is no input that can be run.
inline constexpr std::string_view refused_mark = "refused: ";
/// Begin the failure of a run that broke the program.
inline constexpr std::string_view died_mark = "the program died of signal ";
inline constexpr std::string_view internal_error_mark = "plumbline: internal error";

/// Of the walks that failed, were cut short or have other warnings: a line for each scenario, variant and start, with
/// the first reason.
[[nodiscard]] std::vector<std::string> walk_notes(const std::vector<SweepRow>& rows);
[[nodiscard]] bool is_refused(const SweepRow& row);
/// "house, compass, {room: hall}": scenario, variant and start, as far as there are any.
[[nodiscard]] std::string walks_title(const SweepRow& row);
/// How many runs were refused and why the first was; empty where none was.
[[nodiscard]] std::string refused_in(const std::vector<SweepRow>& rows);
/// The same of runs that broke the program.
[[nodiscard]] std::string broken_in(const std::vector<SweepRow>& rows);

/// Of the position, m: APE of a localization, aligned ATE of SLAM.
[[nodiscard]] std::optional<double> error_of(const SweepRow& row);

/// Rows of the result of a run, as run_result() made it.
[[nodiscard]] std::vector<SweepRow> rows_of(const Tree& result, const std::string& file);

/// The seeds of one scenario, variant, start and method.
struct SweepCell {
  std::string scenario, variant, start, method;
  int runs = 0;
  int failed = 0;  ///< the scenario did
  bool localizes = false;
  int judged = 0;  ///< runs that success counts over: of a localization those identifiable in time
  int succeeded = 0;
  int ambiguous = 0;
  int honest = 0;
  int marginal = 0;            ///< runs between: others are nearly out, or went too late
  int marginal_right = 0;      ///< of them: success or honest_ambiguity
  int false_convergences = 0;  ///< and overconfident answers
  std::map<std::string, int> verdicts;
  std::optional<double> median_identifiable_at_s;  ///< of the identifiable ones
  std::optional<double> median_converged_at_m;     ///< infinite where it is no success; absent when that is the median
  std::optional<double> median_identifiable_at_m;
  /// APE of a localization, aligned ATE of SLAM, of the runs judged; infinite where a run has none; absent when that is
  /// the median.
  std::optional<double> median_error_m;
};
/// In the order in which they come up first.
[[nodiscard]] std::vector<SweepCell> cells_of(std::vector<SweepRow> rows);

/// A line of a .csv file. An apostrophe stands before a word that a spreadsheet would take for a formula.
[[nodiscard]] std::string csv_line(const std::vector<std::string>& words);
[[nodiscard]] std::string runs_csv(const std::vector<SweepRow>& rows);
[[nodiscard]] std::string table_text(const std::vector<SweepCell>& cells);
[[nodiscard]] std::string table_csv(const std::vector<SweepCell>& cells);
/// The same, a line of words each, the heads first.
[[nodiscard]] std::vector<std::vector<std::string>> table_lines(const std::vector<SweepCell>& cells);
/// Writes both as tables `runs` and `cells`, so that the file appears complete or not at all. Throws EnvironmentError.
void write_database(const std::string& path, const std::vector<SweepRow>& rows, const std::vector<SweepCell>& cells);

}  // namespace plumbline::scenarios
