// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "scenarios/hunt/hunt_file.h"
#include "scenarios/hunt/sampling.h"
#include "scenarios/shrink/run_case.h"
#include "scenarios/sweep/scenario_template.h"
#include "slam/methods.h"

namespace plumbline::scenarios {

struct HuntRun;

/// Makes scenarios and buildings of a hunt from what was drawn.
class HuntCases {
 public:
  /// `work`: a folder for buildings that are generated on the way. Throws InputError where a scenario is none, or has
  /// no such key or method.
  HuntCases(const Hunt& hunt, const std::string& work, slam::MethodTable table);

  /// Sets values and case of a run; where the draw gives none, as of sizes that no building has, why.
  void make(HuntRun& run) const;

 private:
  using Bytes = std::shared_ptr<const std::string>;
  [[nodiscard]] RunCase generated(const HuntBase& base, HuntRun& run) const;
  [[nodiscard]] RunCase varied(const ScenarioTemplate& scenario, Bytes bytes, const HuntBase& base, std::size_t first,
                               HuntRun& run) const;
  void check_ends(const HuntBase& base) const;
  void check(const HuntBase& base, Point point) const;

  const Hunt& hunt_;
  std::string work_;
  slam::MethodTable table_;
  std::map<std::string, ScenarioTemplate> templates_;  ///< by path
  std::map<std::string, Bytes> bytes_;                 ///< of their buildings
};

[[nodiscard]] std::vector<std::string> methods_of_case(const RunCase& run);
/// With one method alone and its gates.
[[nodiscard]] RunCase with_method(RunCase run, const std::string& method);

}  // namespace plumbline::scenarios
