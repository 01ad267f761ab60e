// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bim/config/schema.h"
#include "scenarios/spec/scenario.h"
#include "slam/methods.h"

namespace plumbline::scenarios {

/// A set of values of a scenario that are other than its file says.
struct SweepVariant {
  std::string name;
  std::vector<std::string> set;  ///< "prior.yaw=known"
  template <class V>
  void visit(V& v) {
    v("name", name, Field{.doc = "how the table calls it", .required = true});
    v("set", set, Field{.doc = "values of the scenario, as key.key=value, each over what its file says"});
  }
};

/// Many runs, as written by a user (`sweep: 1`): scenarios x variants x starts x seeds, each with all methods.
struct SweepFile {
  int version = 1;
  std::string name = "sweep";
  std::vector<std::string> scenarios;
  int seeds = 10;
  std::uint64_t first_seed = 1;
  std::vector<std::string> methods;
  std::vector<Start> starts;
  std::vector<SweepVariant> variants;
  template <class V>
  void visit(V& v) {
    v("sweep", version, Field{.doc = "version of this format", .min = 1, .max = 1, .required = true});
    v("name", name, Field{.doc = "name of the sweep"});
    v("scenarios", scenarios, Field{.doc = "scenario files, relative to this file", .required = true});
    v("seeds", seeds, Field{.doc = "how many seeds of each", .min = 1, .max = 100000});
    v("first_seed", first_seed, Field{.doc = "the first of them; the others follow it", .min = 0, .max = 9e18});
    v("methods", methods, Field{.doc = "methods of every run; each scenario's own when none is named"});
    v("starts", starts, Field{.doc = "starts in place of the scenarios'"});
    v("variants", variants, Field{.doc = "conditions; the scenarios as they are when none is named"});
  }
};

/// One run of a sweep: what the program is to be asked for.
struct SweepRun {
  std::string key;       ///< of its files, unique in the sweep
  std::string scenario;  ///< name of the scenario's file, without its ending
  std::string variant;   ///< empty when the sweep has none
  std::string start;     ///< in one line of YAML, empty when the sweep has none
  std::uint64_t seed = 0;
  std::size_t text = 0;      ///< of Sweep::scenario_texts, what it runs
  std::string input_digest;  ///< of all that decides about its result, 16 hex digits
  std::string walk_digest;   ///< of all that decides about what is simulated
};

/// Every run of a sweep file, by scenario, variant, start, seed, with the methods of all of them.
struct Sweep {
  SweepFile file;
  std::vector<std::string> scenario_texts;  ///< for all seeds, the building by its whole path
  std::vector<SweepRun> runs;
};

/// Reads a sweep and checks the form of every scenario it makes. seeds: so many of each, 0: as the file says. Throws
/// InputError at the place that is wrong.
[[nodiscard]] Sweep read_sweep(const std::string& path, int seeds = 0, slam::MethodTable table = slam::methods());

[[nodiscard]] const std::vector<std::string>& sweep_examples();
/// The page that documents sweep files, Markdown; scenarios/SWEEP.md is a copy of it.
[[nodiscard]] std::string sweep_page();

}  // namespace plumbline::scenarios
