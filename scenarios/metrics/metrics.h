// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bim/config/tree.h"
#include "scenarios/metrics/localization_score.h"
#include "scenarios/metrics/loop_score.h"
#include "scenarios/metrics/map_score.h"
#include "scenarios/metrics/segmentation_score.h"
#include "scenarios/metrics/structure.h"
#include "scenarios/metrics/trajectory.h"

namespace plumbline::scenarios {
struct GateSpec;
}

namespace plumbline::scenarios::score {

/// What a method says of its own tracking.
struct TrackingScore {
  double lost_share = 0.0;
  double degenerate_share = 0.0;
};

/// Everything scored of one method. What does not apply is absent.
struct MethodScore {
  std::string name;
  std::string verdict;          ///< complete | lost | crashed, or a LocalizationVerdict
  std::string error;            ///< why it crashed
  slam::Nanoseconds shift = 0;  ///< added to the stamps of an outside estimate
  std::optional<TrajectoryScore> trajectory;
  std::optional<TrackingScore> tracking;
  std::optional<MapScore> map;
  std::optional<RoomScore> rooms;
  std::optional<WallScore> walls;
  std::optional<StoreyScore> storeys;
  std::optional<LoopScore> loops;
  std::optional<SegmentationScore> segmentation;
  std::optional<LocalizationScore> localization;
};

enum class Better { lower, higher, neither };

/// One metric: its name in results.json (a dot for a block), unit, direction, description and value.
struct MetricRow {
  std::string_view name;
  std::string_view unit;
  Better better = Better::neither;
  std::string_view doc;  ///< one sentence without its full stop
  std::function<std::optional<double>(const MethodScore&)> value;
  bool also_when_lost = false;  ///< a gate on it judges a method that is lost, too
};

/// Every metric, in the order of results.json. Adding a metric is adding a row.
[[nodiscard]] std::span<const MetricRow> metrics();
/// Row of a metric, or nullptr.
[[nodiscard]] const MetricRow* find_metric(std::string_view name);

/// The method's block of results.json.
[[nodiscard]] Tree to_results(const MethodScore& score);

struct GateResult {
  std::string metric;
  std::string method;
  std::string op;  ///< "<=" or ">="
  double limit = 0.0;
  std::optional<double> value;  ///< absent when the metric is
  std::string but;              ///< why it fails whatever the value is, or has none; empty where the value decides
  bool passed = false;
  std::string see = {};  ///< of a failed one: "#t=34.1&m=vgicp", where the replay page shows why
};

/// A gate fails also when its metric is absent, and where there is a reason why it does whatever the value is.
[[nodiscard]] GateResult judge_gate(const GateSpec& gate, const std::string& method, std::optional<double> value,
                                    std::string but = "");
/// Gates of a run: they fail also when their method crashed or covers less than the run (where the metric
/// is not also_when_lost), and when the run itself did not come to its end.
[[nodiscard]] std::vector<GateResult> judge_gates(const std::vector<GateSpec>& gates,
                                                  const std::vector<MethodScore>& scores, bool run_completed);
[[nodiscard]] Tree to_results(const GateResult& gate);
/// "ate_aligned_rmse_m of vgicp is 0.3, must be <= 0.25"
[[nodiscard]] std::string describe(const GateResult& gate);
/// A gate's value with four significant digits, or as many as show on which side of the limit it is.
[[nodiscard]] std::string gate_value(double value, double limit);

/// JUnit XML: one suite a run, a case that the walk was done (`failure`: why it was not), one a gate, and one a method
/// that it did not crash.
[[nodiscard]] std::string write_junit(const std::string& suite, const std::vector<GateResult>& gates,
                                      const std::vector<MethodScore>& scores, const std::string& failure);

}  // namespace plumbline::scenarios::score
