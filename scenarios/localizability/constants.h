// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <numbers>

namespace plumbline::scenarios {

inline constexpr double rad_per_deg = std::numbers::pi / 180.0;

/// The constants of identifiability. Changing one changes every published table, and the changelog must say so.
struct LocalizabilityConstants {
  double step_m = 0.5;  ///< one scan per this distance of the run
  int azimuths = 360;   ///< beams a ring
  std::array<double, 8> elevations_deg = {-15.0, -11.0, -7.0, -3.0, 1.0, 5.0, 9.0, 13.0};  ///< every second VLP-16 ring
  double sensor_sigma_m = 0.012;    ///< range noise of a VLP-16 at room distances (6-18 mm)
  double model_sigma_m = 0.02;      ///< what a plan leaves open
  double residual_cap_sigma = 3.0;  ///< residuals count no further
  double correlation = 8.0;   ///< the log-likelihood ratio is divided by this: neighbouring beams are not independent
  double drop_llr = 20.0;     ///< a hypothesis above this is dropped
  double marginal_llr = 5.0;  ///< between this and drop_llr it is marginal
  double range_max_m = 100.0;
  double grid_m = 0.5;           ///< spacing of candidate places; half the basin of the refinement
  double known_yaw_deg = 10.0;   ///< with a compass, headings further off than this are no candidates
  double min_clearance_m = 0.3;  ///< a robot's centre is never nearer to a wall
  double distinct_m = 0.5;       ///< nearer than this and distinct_deg to the truth is the truth
  double distinct_deg = 10.0;
  double same_alias_m = 0.3;  ///< two aliases nearer to each other than this and same_alias_deg are one
  double same_alias_deg = 6.0;
  int signature_azimuths = 72;      ///< beams a ring of the views by which candidates are chosen
  double signature_range_m = 30.0;  ///< ranges count no further there
  double like_quantiles_m = 0.6;    ///< candidates' ranges, sorted, differ by no more than this on average
  double like_level_m = 0.55;       ///< nor do those of the level ring, turned to the candidate's heading,
  double like_level_cap_m = 1.0;    ///< each counted up to this
  int headings_a_place = 4;         ///< kept, best first
  int max_seeds = 400;              ///< refined candidates, best first
  int give_up_after = 50;           ///< candidates in a row that lead to no alias, of a map
  int give_up_after_of_run = 200;   ///< and of a run: along a corridor of 38 m more than 50 come before the half turn
  double basin_m = 0.3;             ///< a candidate this near to one refined before would end where that did
  double basin_deg = 10.0;
  int refine_azimuths = 72;  ///< beams a ring while refining
  std::array<double, 3> refine_elevations_deg = {-7.0, 1.0, 9.0};
  int refine_iterations = 14;
};
inline constexpr LocalizabilityConstants localizability_constants;

}  // namespace plumbline::scenarios
