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
  std::vector<std::string> set;
  template <class V>
  void visit(V& v) {
    v("name", name, Field{.doc = "name of the variant in tables", .required = true});
    v("set", set,
      Field{.doc = "values that replace those of the scenario, as key.key=value, for example prior.yaw=known"});
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
  std::vector<ProcessSpec> processes;
  std::vector<Sensors> sensors;
  std::vector<Start> starts;
  std::vector<SweepVariant> variants;
  template <class V>
  void visit(V& v) {
    v("sweep", version, plain_field("version of the format", {.min = 1, .max = 1, .required = true}));
    v("name", name, Field{.doc = "name of the sweep"});
    v("scenarios", scenarios, Field{.doc = "paths of the scenarios, relative to the sweep's folder", .required = true});
    v("seeds", seeds, plain_field("number of seeds of each scenario", {.min = 1, .max = 100000}));
    v("first_seed", first_seed, plain_field("first seed; the others follow it", {.min = 0, .max = 9e18}));
    v("methods", methods,
      Field{.doc = "names of the methods of every run; each scenario's own when none is named; `{name: NAME, command: "
                   "[PROGRAM, ARGUMENT]}` for a process of your own, as in a scenario"});
    v("processes", processes,
      Field{.doc = "methods that are programs of the user's, as in a scenario; they start in the sweep's folder when "
                   "they say none"});
    v("sensors", sensors,
      Field{.doc = "what methods get in every run, as in a scenario: [all, lidar] runs each that can with LiDAR alone, "
                   "too; each scenario's own when not given"});
    v("starts", starts, Field{.doc = "starts that replace those of the scenarios"});
    v("variants", variants, Field{.doc = "variants of the scenarios; the scenarios unchanged when none is given"});
  }
};

/// One run of a sweep: what the program is to be asked for.
struct SweepRun {
  std::string key;       ///< of its files, unique in the sweep
  std::string scenario;  ///< name of the scenario's file, without its ending
  std::string variant;   ///< empty when the sweep has none
  std::string start;     ///< in one line of YAML, empty when the sweep has none
  std::uint64_t seed = 0;
  std::size_t text = 0;           ///< of Sweep::scenario_texts, what it runs
  std::string input_digest;       ///< of all that decides about its result, 16 hex digits
  std::string simulation_digest;  ///< of all that decides about its simulation
};

/// Every run of a sweep file, by scenario, variant, start, seed, with the methods of all of them.
struct Sweep {
  SweepFile file;
  std::string file_name;                    ///< of the sweep file, without its folder
  std::vector<std::string> scenario_texts;  ///< for all seeds, the building by its whole path
  std::vector<SweepRun> runs;
  int seeds = 0;                   ///< asked for in place of the file's; 0: the file's
  std::vector<std::string> notes;  ///< what a user should know of it, sentences
};

/// Reads a sweep and checks the form of every scenario it makes. seeds: so many of each, 0: as the file says. Throws
/// InputError at the place that is wrong.
[[nodiscard]] Sweep read_sweep(const std::string& path, int seeds = 0, slam::MethodTable table = slam::methods());

}  // namespace plumbline::scenarios
