// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/bench/bench.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bim/errors.h"
#include "bim/median.h"

namespace plumbline::scenarios {

namespace {

std::string limit_text(const BenchRow& row) {
  if (!row.limit) return "";
  char text[96];
  std::snprintf(text, sizeof text, "%s %.4g  %s%s", row.limit->at_most ? "<=" : ">=", row.limit->value,
                row.limit->gates ? "gate" : "target", row.passed() ? "" : (row.limit->gates ? " FAILED" : " missed"));
  return text;
}

}  // namespace

bool BenchRow::passed() const {
  if (!limit) return true;
  return limit->at_most ? value <= limit->value : value >= limit->value;
}

BenchRow make_row(std::string name, std::string unit, std::vector<double> samples, std::optional<BenchLimit> limit) {
  if (samples.empty()) throw InternalError("bench: no samples of " + name);
  std::sort(samples.begin(), samples.end());
  return {std::move(name), std::move(unit), median(samples), samples.front(), samples.back(), limit};
}

double growth_exponent(double n0, double cost0, double n1, double cost1) {
  return std::log(cost1 / cost0) / std::log(n1 / n0);
}

const std::vector<BenchPart>& bench_parts() {
  static const std::vector<BenchPart> parts = {
      {"bim", "reading, cutting and comparing buildings, and how it grows with the number of walls", bench_bim},
      {"identify", "the localizability map, and how its cost grows with the number of grid points", bench_identify},
      {"lidar", "casting rays, against a plain loop over Embree, and how it grows with the number of triangles",
       bench_lidar},
      {"localize",
       "s_graph_localization: an update of the particles, how it grows with particles and walls, whole walks",
       bench_localize},
      {"slam", "s_graphs_plus, stage by stage, on quickstart walks with a seed each, and how it grows over 1,020 s",
       bench_slam},
      {"sim", "walking and scanning in 100 rooms, against real time, and the memory it takes", bench_sim},
      {"legs",
       "laps of 120 s on several floors and stairs up and down, with a seed each: falls, speed and cross-track errors",
       bench_legs},
      {"walks",
       "default walks through hundreds of generated buildings with faults, and how planning grows with the floor",
       bench_walks}};
  return parts;
}

Tree bench_json(const std::vector<BenchRow>& rows) {
  Tree list = Tree::list();
  for (const BenchRow& row : rows) {
    Tree one = Tree::map();
    one.set("name", row.name).set("value", row.value).set("unit", row.unit).set("low", row.low).set("high", row.high);
    if (row.limit) {
      one.set("limit", row.limit->value).set("op", row.limit->at_most ? "<=" : ">=");
      one.set("gate", row.limit->gates).set("passed", row.passed());
    }
    list.push(std::move(one));
  }
  Tree tree = Tree::map();
  tree.set("bench", std::move(list));
  return tree;
}

std::string bench_text(const std::vector<BenchRow>& rows) {
  std::string text;
  for (const BenchRow& row : rows) {
    char line[256];
    std::snprintf(line, sizeof line, "  %-32s %10.4g %-6s (%.4g to %.4g)  %s", row.name.c_str(), row.value,
                  row.unit.c_str(), row.low, row.high, limit_text(row).c_str());
    std::string trimmed = line;
    trimmed.erase(trimmed.find_last_not_of(' ') + 1);
    text += trimmed + "\n";
  }
  return text;
}

}  // namespace plumbline::scenarios
