// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/hunt/hunt_file.h"
#include "scenarios/hunt/sampling.h"
#include "scenarios/shrink/run_case.h"
#include "scenarios/sweep/scenario_template.h"
#include "slam/methods.h"

namespace plumbline::scenarios {

struct HuntRun;
/// What was drawn, by key.
using DrawnValues = std::vector<std::pair<std::string, std::string>>;

/// Makes scenarios and buildings of a hunt from what was drawn.
class HuntCases {
 public:
  /// `work`: a folder for buildings that are generated on the way. Throws InputError where a scenario is none, or has
  /// no such key or method.
  HuntCases(const Hunt& hunt, const std::string& work, slam::MethodTable table);

  [[nodiscard]] DrawnValues values_at(const HuntBase& base, const Point& point) const;
  /// Sets values and case of a run; where the draw gives none, as of sizes that no building has, why.
  void make(HuntRun& run) const;

 private:
  using Bytes = std::shared_ptr<const std::string>;
  [[nodiscard]] RunCase generated(const HuntBase& base, const HuntRun& run) const;
  [[nodiscard]] RunCase varied(const ScenarioTemplate& scenario, Bytes bytes, const HuntBase& base, std::size_t first,
                               const HuntRun& run) const;
  void check_ends(const HuntBase& base) const;
  void check(const HuntBase& base, const Point& point) const;
  void check_gated(const std::vector<std::string>& methods, slam::MethodTable table) const;

  const Hunt& hunt_;
  std::string work_;
  slam::MethodTable table_;
  std::map<std::string, ScenarioTemplate> templates_;  ///< by path
  std::map<std::string, Bytes> bytes_;                 ///< of their buildings
};

}  // namespace plumbline::scenarios
