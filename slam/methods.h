// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "bim/config/schema.h"
#include "slam/io/method.h"

namespace plumbline::slam {

/// One row of the table of estimators.
struct MethodRow {
  std::string_view name = {};  ///< of literals, as is the summary
  std::string_view summary = {};
  bool needs_plan = false;
  std::function<std::unique_ptr<Method>(const MethodInput&)> make = {};
  bool standard = true;             ///< runs where neither scenario nor command line names methods
  bool needs_odometry = false;      ///< else it assumes constant velocity where there is none
  bool uses_odometry = true;        ///< false: LiDAR alone, records of odometry and IMU are ignored
  bool variant = false;             ///< another row's method with other defaults
  std::string_view former = {};     ///< its name in the version before; refused with the new one
  std::string_view seed_name = {};  ///< from which its seed derives; empty: name
  /// Every value of the method's config struct: those of the tree (which may be null) over the defaults. Throws
  /// InputError. Empty where the method has no config.
  std::function<Tree(const Tree&)> configure = {};
  std::function<std::vector<SchemaSection>()> config_schema = {};  ///< its keys; empty where there is no config
};

/// The row of a method that reads its config by config_of<Config>.
template <class Config>
[[nodiscard]] MethodRow with_config(MethodRow row) {
  row.configure = [](const Tree& tree) { return to_tree(tree.is_null() ? Config{} : from_tree<Config>(tree)); };
  row.config_schema = [] { return SchemaVisitor::sections_of<Config>(); };
  return row;
}

/// Estimators to choose from: ours, or ours and those a program brings along.
using MethodTable = std::span<const MethodRow>;

/// Ours, in the order of `plumbline methods`.
[[nodiscard]] MethodTable methods();
/// What method_seed() takes for this row.
[[nodiscard]] inline std::string_view seed_name(const MethodRow& row) {
  return row.seed_name.empty() ? row.name : row.seed_name;
}
/// Row of a method, or nullptr.
[[nodiscard]] const MethodRow* find_method(std::string_view name, MethodTable table = methods());

}  // namespace plumbline::slam
