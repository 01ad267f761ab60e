// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenarios/report/obstacles.h"

namespace plumbline::scenarios {

inline constexpr std::string_view plan_drawing_name = "plan.json";

/// What the page of an estimate draws of the plan that its method had, in W. The plan holds storeys, faces and rooms.
struct PlanDrawing {
  bim::Plan plan;
  std::vector<ReportObstacle> obstacles;
  std::vector<ReportFlight> flights;
};

/// `told`: the plan as the method had it, rooms with the names to be shown; furniture that it was not told of is left
/// out.
[[nodiscard]] PlanDrawing plan_drawing(const bim::Building& as_planned, const bim::Plan& told);

/// plan.json: lengths in m, to 1 mm.
[[nodiscard]] std::string write_plan_drawing(const PlanDrawing& drawing);
/// Throws InputError.
[[nodiscard]] PlanDrawing read_plan_drawing(std::string_view text, const std::string& file);

}  // namespace plumbline::scenarios
