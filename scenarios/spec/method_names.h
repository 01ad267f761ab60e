// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenarios/spec/sensors.h"
#include "slam/methods.h"

namespace plumbline::scenarios {

/// Name of the row the runner adds to the table of estimators: the method that knows the truth.
inline constexpr std::string_view truth_method = "truth";

/// Names of every method a scenario may ask for, in the order of `plumbline methods`.
[[nodiscard]] std::vector<std::string> method_names(slam::MethodTable table = slam::methods());

/// Row of a method by its name or label, or nullptr.
[[nodiscard]] const slam::MethodRow* row_of(std::string_view label, slam::MethodTable table);
[[nodiscard]] bool runs_on_lidar_alone(const slam::MethodRow& row);

/// Labels of a method that is run once with each of the sensors; with all where none is given. A label that says
/// `.lidar` stays as it is, and so does the truth. Beside all, a method that needs odometry is not run with less.
[[nodiscard]] std::vector<std::string> labels_of(const std::string& method, const std::vector<Sensors>& sensors,
                                                 slam::MethodTable table);

}  // namespace plumbline::scenarios
