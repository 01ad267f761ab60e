// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenarios/sweep/table.h"

namespace plumbline::scenarios {

/// One method in one run before and after: scenario, variant, start, seed and method are the same.
struct RowPair {
  SweepRow a;
  SweepRow b;
};

struct PairedRows {
  std::vector<RowPair> pairs;  ///< in the order of A
  std::vector<SweepRow> only_a;
  std::vector<SweepRow> only_b;
};

/// Pairs rows by scenario, variant, start, seed and method. Of rows that agree in all five the first of A goes with the
/// first of B, and so on.
[[nodiscard]] PairedRows pair_rows(const std::vector<SweepRow>& a, const std::vector<SweepRow>& b);

/// "house, compass, {room: hall}, seed 3": the run of a row, as far as it has these.
[[nodiscard]] std::string run_title(const SweepRow& row);

/// Whether both runs had the same sensor data, byte for byte; absent where digests do not tell.
[[nodiscard]] std::optional<bool> same_sensor_data(const RowPair& pair);
/// Whether the method did the same, byte for byte, and is scored the same.
[[nodiscard]] bool is_same(const RowPair& pair);
/// Whether a score, the sensor data or a digest of the method is known to differ. Neither where no digest tells.
[[nodiscard]] bool is_different(const RowPair& pair);

/// The verdict is complete, success, or honest_ambiguity where the pose is not identifiable.
[[nodiscard]] bool is_right(const SweepRow& row);
/// A wrong pose was claimed: false_convergence or overconfident.
[[nodiscard]] bool is_wrong(const SweepRow& row);
/// The walk failed, so that nothing is known of the method.
[[nodiscard]] bool is_failed(const SweepRow& row);

}  // namespace plumbline::scenarios
