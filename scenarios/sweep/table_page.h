// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <vector>

#include "scenarios/sweep/table.h"

namespace plumbline::scenarios {

/// What a sweep's page says beside its rows.
struct SweepPage {
  std::string name;
  std::string file;             ///< of the sweep, without its folder
  std::set<std::string> pages;  ///< keys of the runs whose pages are in pages/KEY
  int seeds = 0;                ///< asked for in place of the file's; 0: the file's
};

/// Rows from the worst to the best: wrong or failed ones first, then by error, then as they stand.
[[nodiscard]] std::vector<const SweepRow*> worst_first(const std::vector<SweepRow>& rows);

/// The table of the cells with the spread of their errors, and every run, worst first: its page, or the command that
/// makes it.
[[nodiscard]] std::string table_html(const SweepPage& page, const std::vector<SweepRow>& rows,
                                     const std::vector<SweepCell>& cells);

}  // namespace plumbline::scenarios
