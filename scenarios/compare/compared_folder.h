// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenarios/sweep/table.h"

namespace plumbline::scenarios {

/// What a folder holds for a comparison.
struct ComparedFolder {
  bool is_sweep = false;  ///< or a run
  std::vector<SweepRow> rows;
  std::vector<std::string> notes;  ///< what the reader should know of it
};

/// Reads a run directory or the folder of a sweep. The row `truth` is left out: it checks scores and is no method.
/// Throws InputError where it is neither, is unfinished or holds no method.
[[nodiscard]] ComparedFolder read_compared_folder(const std::string& path);

/// Rows of runs.csv, as runs_csv() writes it. Columns of other programs are left out, missing ones have no values.
/// Throws InputError.
[[nodiscard]] std::vector<SweepRow> read_runs_csv(std::string_view text, const std::string& file);

}  // namespace plumbline::scenarios
