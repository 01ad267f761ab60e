// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bim/plan/plan.h"
#include "slam/io/method.h"
#include "tests/slam/synthetic.h"

namespace plumbline::slam::synthetic {

/// Outputs of a method of the table on a walk, its config given as YAML ("" for the defaults).
struct PlanWalkAnswers {
  std::vector<Output> outputs;
  Estimate estimate;
};
[[nodiscard]] PlanWalkAnswers localize(const std::string& method, const Recording& recording, const bim::Plan& plan,
                                       bool yaw_known, const std::string& config = "");

/// The corridor house's walk, seconds long, with a range bias and an odometry 1 % short.
[[nodiscard]] Recording biased_walk(double seconds);
/// Distance of the last answer from the truth, m; infinite when there is none.
[[nodiscard]] double last_error(const PlanWalkAnswers& answers, const Recording& recording);

}  // namespace plumbline::slam::synthetic
