// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bim/config/tree.h"
#include "scenarios/spec/method_names.h"
#include "scenarios/sweep/sweep_file.h"

namespace plumbline::scenarios {

/// A scenario's text with some of its values replaced.
class ScenarioTemplate {
 public:
  /// Throws InputError, at the mark where the file is no scenario.
  ScenarioTemplate(const std::string& path, const Mark& mark);

  [[nodiscard]] std::string name() const;
  /// Whole path of the building.
  [[nodiscard]] const std::string& building() const { return building_; }
  /// Empty where it does not exist.
  [[nodiscard]] const std::string& building_bytes() const { return building_bytes_; }

  /// The scenario with what a sweep asks for; its form is checked.
  [[nodiscard]] Tree with(const SweepVariant& variant, const Start* start, const SweepFile& sweep, const Mark& mark,
                          slam::MethodTable table) const;
  /// The scenario with the processes of the sweep beside its own.
  void add(const Tree& processes);
  /// The table with the scenario's processes; `mark` is where the sweep names the scenario.
  [[nodiscard]] ProcessTable methods(slam::MethodTable table, const Mark& mark) const;
  /// With the building by its whole path.
  [[nodiscard]] std::string text(Tree tree) const;

 private:
  /// A place in the text made here would be none that the user wrote.
  [[nodiscard]] Scenario check(const Tree& tree, const SweepVariant& variant, const Mark& mark) const;

  std::string path_;
  std::string building_;
  std::string building_bytes_;
  Tree tree_;
};

}  // namespace plumbline::scenarios
