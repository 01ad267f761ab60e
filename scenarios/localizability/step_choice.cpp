// SPDX-License-Identifier: Apache-2.0
#include "scenarios/localizability/step_choice.h"

#include <algorithm>
#include <cmath>

#include "scenarios/localizability/localizability_map.h"

namespace plumbline::scenarios {

namespace {

/// The k-th coarser step: two steps double it.
double step_at(double finest_m, int k) {
  if (k == 0) return finest_m;
  const double step = finest_m * std::pow(2.0, 0.5 * k);
  return std::round(10.0 * step) / 10.0;
}

double places_at(const MapWork& coarse, double step_m) {
  return static_cast<double>(coarse.places) * std::pow(coarse.step_m / step_m, 2.0);
}

}  // namespace

double expected_beams(const MapWork& coarse, double step_m, const StepBudget& budget) {
  const double more = places_at(coarse, step_m) / std::max(1.0, static_cast<double>(coarse.places));
  return static_cast<double>(coarse.beams) * std::pow(more, budget.growth);
}

double finest_step(const MapWork& coarse, double beams_left, double finest_m, const StepBudget& budget) {
  constexpr double margin = 0.9;  // a finer grid also finds places where a coarser one has none
  for (int k = 0; step_at(finest_m, k) < coarse.step_m; ++k) {
    const double step = step_at(finest_m, k);
    if (places_at(coarse, step) <= margin * static_cast<double>(most_map_cells) &&
        expected_beams(coarse, step, budget) <= beams_left)
      return step;
  }
  return coarse.step_m;
}

double growth_between(const MapWork& coarse, const MapWork& fine) {
  if (coarse.beams == 0 || fine.places <= coarse.places) return StepBudget().growth;
  const double places = static_cast<double>(fine.places) / static_cast<double>(std::max<std::size_t>(coarse.places, 1));
  const double beams = static_cast<double>(fine.beams) / static_cast<double>(coarse.beams);
  return std::clamp(std::log(beams) / std::log(places), 1.0, 2.0);
}

double coarse_step(double area_m2, double finest_m, const StepBudget& budget) {
  int k = 0;
  while (area_m2 > budget.coarse_places * step_at(finest_m, k) * step_at(finest_m, k)) ++k;
  return step_at(finest_m, k);
}

}  // namespace plumbline::scenarios
