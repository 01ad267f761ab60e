// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bim/config/visit.h"
#include "scenarios/spec/scenario.h"

namespace plumbline::scenarios {

/// Values that one key may have: a list of them, or a range.
struct HuntRange {
  std::string key;
  std::vector<std::string> values;
  std::optional<double> min;
  std::optional<double> max;
  bool log = false;
  bool whole = false;
  template <class V>
  void visit(V& v) {
    v("key", key,
      Field{.doc = "key of the scenario, dotted below a block, as lidar.rpm; of a family, its option, as epsilon_m",
            .required = true});
    v("values", values, Field{.doc = "values of the key, each as it stands in a scenario; or else min and max"});
    v("min", min, plain_field("least value, in the key's unit", {.min = -1e9, .max = 1e9}));
    v("max", max, plain_field("greatest value, in the key's unit", {.min = -1e9, .max = 1e9}));
    v("log", log, Field{.doc = "whether equal ratios are equally likely, not equal differences; min is more than 0"});
    v("whole", whole, Field{.doc = "whether values are whole numbers; options of a family know it by themselves"});
  }
};

/// A family of generated buildings to hunt in.
struct HuntFamily {
  std::string family;
  std::vector<HuntRange> options;
  template <class V>
  void visit(V& v) {
    v("family", family, Field{.doc = "name of the family, see `plumbline generate`", .required = true});
    v("options", options, Field{.doc = "options of the family to vary; its seed is drawn when it is not among them"});
  }
};

/// A search for failures, as written by a user (`hunt: 1`).
struct HuntFile {
  int version = 1;
  std::string name = "hunt";
  std::vector<std::string> scenarios;
  std::vector<HuntFamily> generate;
  std::vector<HuntRange> vary;
  std::vector<std::string> methods;
  std::vector<GateSpec> gates;
  int runs = 100;
  double refine = 0.5;
  std::uint64_t seed = 1;
  template <class V>
  void visit(V& v) {
    v("hunt", version, plain_field("version of the format", {.min = 1, .max = 1, .required = true}));
    v("name", name, Field{.doc = "name of the hunt"});
    v("scenarios", scenarios, Field{.doc = "paths of scenarios to vary, relative to the hunt's folder"});
    v("generate", generate,
      Field{.doc = "families of buildings to draw from, each with a walk through all rooms of the start's storey"});
    v("vary", vary, Field{.doc = "keys of the scenarios that are drawn anew for every run"});
    v("methods", methods,
      Field{.doc = "names of the methods of every run; each scenario's own when none is named; a process of yours is "
                   "declared in the scenario"});
    v("gates", gates, Field{.doc = "bounds that every run is to keep, in place of those of the scenarios"});
    v("runs", runs, plain_field("number of runs", {.min = 1, .max = 100000}));
    v("refine", refine, share_field("share of the runs that are drawn near the worst ones"));
    v("seed", seed, plain_field("seed of all draws", {.min = 0, .max = 9.2e18}));
  }
};

/// What runs are made of: a scenario of the user's, or a family.
struct HuntBase {
  std::string name;      ///< of the scenario's file or of the family
  std::string scenario;  ///< path; empty of a family
  std::optional<HuntFamily> family;
  Mark mark;
  /// What is drawn: options of the family, then keys of the scenario.
  [[nodiscard]] std::size_t dimensions(const HuntFile& file) const {
    return (family ? family->options.size() : 0) + file.vary.size();
  }
};

struct Hunt {
  HuntFile file;
  std::vector<HuntBase> bases;
  std::vector<Mark> gate_marks;  ///< where each gate stands
};

/// Reads a hunt and checks ranges, names of families and their options. Throws InputError at the place that is wrong.
[[nodiscard]] Hunt read_hunt(const std::string& path);

}  // namespace plumbline::scenarios
