// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <filesystem>

#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/load/load.h"
#include "bim/mesh/mesh.h"
#include "bim/symmetry/symmetry.h"
#include "scenarios/app/bench/bench.h"
#include "scenarios/app/bench/child.h"
#include "scenarios/app/bench/lattice.h"
#include "slam/io/stopwatch.h"

namespace plumbline::scenarios {

namespace {

/// What is asked of one core; times are targets, for they depend on the machine.
struct BimLimits {
  double inspect_duplex_s = 0.8;
  double inspect_duplex_mb = 150.0;
  double symmetry_duplex_s = 1.0;
  double mesh_1000_walls_s = 1.5;
  double growth = 1.35;  ///< exponent from 1,000 to 10,000 walls: n log n is 1.13 there, caches cost the rest
};

/// CPU seconds of the stages of one plan.
struct PlanCost {
  std::vector<double> read, mesh, symmetry;
};

double symmetry_cost(const bim::Building& building) {
  const slam::Stopwatch watch;
  const bim::SymmetryReport report = bim::analyse_symmetry(building);
  return 1e-3 * watch.cpu_ms();
}

PlanCost cost_of(int walls, int repetitions) {
  const std::string text = lattice_plan(walls);
  PlanCost cost;
  for (int k = 0; k < repetitions; ++k) {
    const slam::Stopwatch reading;
    const bim::Building building = bim::read_plan_text(text, "lattice");
    cost.read.push_back(1e-3 * reading.cpu_ms());
    const slam::Stopwatch meshing;
    const bim::BuildingMesh mesh = bim::build_mesh(building);
    cost.mesh.push_back(1e-3 * meshing.cpu_ms());
    cost.symmetry.push_back(symmetry_cost(building));
  }
  return cost;
}

void measure_duplex(const BenchSetting& setting, std::vector<BenchRow>& rows) {
  const std::string path = setting.data_dir + "/ifc/duplex.ifc";
  if (setting.data_dir.empty() || !std::filesystem::exists(path)) {
    std::fprintf(stderr, "plumbline: no ifc/duplex.ifc in --data: its rows are left out\n");
    return;
  }
  std::vector<double> cpu, memory, symmetry;
  const bim::Building duplex = bim::load_building(path);
  for (int k = 0; k < setting.repetitions; ++k) {
    setting.step();
    const ChildCost cost = run_self({"inspect", path});
    cpu.push_back(cost.cpu_s);
    memory.push_back(cost.peak_rss_mb);
    symmetry.push_back(symmetry_cost(duplex));
  }
  const BimLimits limits;
  rows.push_back(make_row("bim.inspect_duplex_s", "s", cpu, BenchLimit{limits.inspect_duplex_s}));
  rows.push_back(make_row("bim.inspect_duplex_mb", "MB", memory, BenchLimit{limits.inspect_duplex_mb}));
  rows.push_back(make_row("bim.symmetry_duplex_s", "s", symmetry, BenchLimit{limits.symmetry_duplex_s}));
}

/// Medians of the stages at one size, appended as rows.
std::vector<double> append(const PlanCost& cost, int walls, std::vector<BenchRow>& rows) {
  const std::string size = std::to_string(walls) + "_walls_s";
  rows.push_back(make_row("bim.read_" + size, "s", cost.read));
  rows.push_back(make_row("bim.mesh_" + size, "s", cost.mesh));
  rows.push_back(make_row("bim.symmetry_" + size, "s", cost.symmetry));
  return {rows[rows.size() - 3].value, rows[rows.size() - 2].value, rows[rows.size() - 1].value};
}

void measure_growth(const BenchSetting& setting, std::vector<BenchRow>& rows) {
  constexpr int small = 1000, large = 10000;
  const BimLimits limits;
  (void)append(cost_of(100, setting.repetitions), 100, rows);
  const std::vector<double> before = append(cost_of(small, setting.repetitions), small, rows);
  rows[rows.size() - 2].limit = BenchLimit{limits.mesh_1000_walls_s};
  const std::vector<double> after = append(cost_of(large, 1), large, rows);
  const std::vector<std::string> names = {"bim.read_growth", "bim.mesh_growth", "bim.symmetry_growth"};
  for (std::size_t i = 0; i < names.size(); ++i)
    rows.push_back(make_row(names[i], "power", {growth_exponent(small, before[i], large, after[i])},
                            BenchLimit{limits.growth, true, true}));
}

}  // namespace

std::vector<BenchRow> bench_bim(const BenchSetting& setting) {
  std::vector<BenchRow> rows;
  measure_duplex(setting, rows);
  measure_growth(setting, rows);
  return rows;
}

}  // namespace plumbline::scenarios
