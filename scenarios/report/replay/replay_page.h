// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "bim/config/tree.h"
#include "scenarios/report/replay/scan_packer.h"
#include "scenarios/run/finished_run.h"
#include "scenarios/score/score_run.h"

namespace plumbline::scenarios {

struct ReplayOptions {
  std::size_t most_bytes =
      15'000'000;  ///< of the page: scans are left out, away from what is worth a look, until it fits
};

/// One self-contained HTML page with the run in three dimensions at any of its times. `graphs`: the graph file of each
/// method that has one. The same run gives the same bytes.
[[nodiscard]] std::string render_replay(const FinishedRun& run, const score::RunScore& score, const ScanPacker& scans,
                                        const std::map<std::string, Tree>& graphs, const ReplayOptions& options = {});

/// The scans that a page of so many bytes holds: all if they fit; else all near `moments_s` and one of so many
/// elsewhere.
[[nodiscard]] std::vector<std::size_t> kept_scans(const std::vector<PackedScan>& scans,
                                                  const std::vector<double>& moments_s, std::size_t most_bytes);

}  // namespace plumbline::scenarios
