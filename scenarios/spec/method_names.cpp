// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/method_names.h"

#include <algorithm>

namespace plumbline::scenarios {

std::vector<std::string> method_names(slam::MethodTable table) {
  std::vector<std::string> names;
  for (const slam::MethodRow& row : table) names.emplace_back(row.name);
  names.emplace_back(truth_method);
  return names;
}

const slam::MethodRow* row_of(std::string_view label, slam::MethodTable table) {
  const std::string name = choice_of(label).method;
  const auto row = std::find_if(table.begin(), table.end(), [&](const slam::MethodRow& r) { return r.name == name; });
  return row == table.end() ? nullptr : &*row;
}

bool runs_on_lidar_alone(const slam::MethodRow& row) { return !row.needs_odometry; }

std::vector<std::string> labels_of(const std::string& method, const std::vector<Sensors>& sensors,
                                   slam::MethodTable table) {
  if (sensors.empty() || method == truth_method || method.ends_with(lidar_ending)) return {method};
  const bool with_all = std::find(sensors.begin(), sensors.end(), Sensors::all) != sensors.end();
  const slam::MethodRow* row = row_of(method, table);
  std::vector<std::string> labels;
  for (const Sensors each : sensors) {
    if (each == Sensors::lidar && with_all && row != nullptr && !runs_on_lidar_alone(*row)) continue;
    labels.push_back(MethodChoice{method, each}.label());
  }
  return labels;
}

}  // namespace plumbline::scenarios
