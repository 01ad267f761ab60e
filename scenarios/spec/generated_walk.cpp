// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/generated_walk.h"

#include <cmath>

#include "bim/formats/plan_yaml/plan_yaml.h"
#include "scenarios/spec/route_plan.h"

namespace plumbline::scenarios {

Scenario generated_walk(const bim::GeneratedPlan& generated, const std::string& plan_text,
                        const std::string& building) {
  constexpr double slower_than_planned = 1.5;
  constexpr double at_rest_s = 30.0;
  Scenario scenario;
  scenario.name = generated.plan.name;
  scenario.building = building;
  scenario.start.room = generated.start;
  scenario.route.rooms = generated.rooms;
  const Mark mark{building, 0, 0};
  const RoutePlan route =
      plan_route(bim::read_plan_text(plan_text, building), scenario.start, scenario.route, {mark, mark, {}});
  scenario.duration_s = std::ceil(slower_than_planned * route.length_m / scenario.speed_mps + at_rest_s);
  return scenario;
}

}  // namespace plumbline::scenarios
