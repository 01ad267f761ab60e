// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string_view>

#include "slam/io/method.h"

namespace plumbline::slam {

/// One row of the table of estimators.
struct MethodRow {
  std::string_view name;
  std::string_view summary;
  bool needs_plan = false;
  std::function<std::unique_ptr<Method>(const MethodInput&)> make;
  bool standard = true;  ///< runs where neither scenario nor command line names methods
};

/// Every estimator, in the order of `plumbline methods`.
[[nodiscard]] std::span<const MethodRow> methods();
/// Row of a method, or nullptr.
[[nodiscard]] const MethodRow* find_method(std::string_view name);

}  // namespace plumbline::slam
