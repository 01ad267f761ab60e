// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bim/config/tree.h"

namespace plumbline::scenarios {

/// Bound on a figure. A ratio within one run gates; an absolute time depends on the machine and is a target only.
struct BenchLimit {
  double value = 0.0;
  bool at_most = true;
  bool gates = false;
};

/// One figure: the median over repetitions, with its spread.
struct BenchRow {
  std::string name;  ///< "bim.mesh_1000_walls_s"
  std::string unit;
  double value = 0.0;
  double low = 0.0;
  double high = 0.0;
  std::optional<BenchLimit> limit;

  /// True without a limit.
  [[nodiscard]] bool passed() const;
};

struct BenchSetting {
  int repetitions = 5;
  std::string library;                 ///< folder with quickstart.yaml and s_graphs/long.yaml
  std::function<void()> step = [] {};  ///< called before each repetition of what takes long
  std::string data_dir;  ///< folder with ifc/duplex.ifc; empty: what needs it is left out, with a line to stderr
};

/// A part of the program whose costs are measured, and what is said of it in help.
struct BenchPart {
  std::string_view name;
  std::string_view summary;
  std::function<std::vector<BenchRow>(const BenchSetting&)> measure;
};
[[nodiscard]] const std::vector<BenchPart>& bench_parts();

/// The median of `samples` (not empty) and their range as a row.
[[nodiscard]] BenchRow make_row(std::string name, std::string unit, std::vector<double> samples,
                                std::optional<BenchLimit> limit = std::nullopt);
/// Exponent e of cost = c n^e between two sizes.
[[nodiscard]] double growth_exponent(double n0, double cost0, double n1, double cost1);

/// {"bench": [{name, value, unit, low, high, limit, op, gate, passed}]}; limit, op, gate and passed only where there
/// is a limit.
[[nodiscard]] Tree bench_json(const std::vector<BenchRow>& rows);
[[nodiscard]] std::string bench_text(const std::vector<BenchRow>& rows);

[[nodiscard]] std::vector<BenchRow> bench_bim(const BenchSetting& setting);
/// The map of a building, what a run lets be known, and how the map grows.
[[nodiscard]] std::vector<BenchRow> bench_identify(const BenchSetting& setting);
[[nodiscard]] std::vector<BenchRow> bench_lidar(const BenchSetting& setting);
/// An update of the particles, how it grows, and the method on walks of the largest floor of the library with a seed
/// each, 1 to setting.repetitions.
[[nodiscard]] std::vector<BenchRow> bench_localize(const BenchSetting& setting);
/// The method on quickstart walks with a seed each, 1 to setting.repetitions, and on one long walk.
[[nodiscard]] std::vector<BenchRow> bench_slam(const BenchSetting& setting);
/// Two real clouds of the data folder, ours against PCL's GICP; empty without them. Part of bench_slam.
[[nodiscard]] std::vector<BenchRow> bench_registration(const BenchSetting& setting);
/// Each walk has its own seed, 1 to setting.repetitions.
[[nodiscard]] std::vector<BenchRow> bench_sim(const BenchSetting& setting);
/// Each walk has its own seed, 1 to setting.repetitions.
[[nodiscard]] std::vector<BenchRow> bench_legs(const BenchSetting& setting);
/// Default walks through generated buildings with faults, two hundred a repetition, against what their
/// construction says; and how planning grows with the floor.
[[nodiscard]] std::vector<BenchRow> bench_walks(const BenchSetting& setting);

}  // namespace plumbline::scenarios
