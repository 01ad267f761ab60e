// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "slam/baselines/amcl/amcl_filter.h"
#include "slam/plan_method/plan_method.h"

namespace plumbline::slam {

struct AmclConfig {
  ScanSliceConfig slice;
  LikelihoodFieldConfig field;
  AmclFilterConfig filter;
  PlanMethodConfig plan;
  MapCloudConfig map;

  template <class V>
  void visit(V& v) {
    v("slice", slice);
    v("field", field);
    v("filter", filter);
    v("plan", plan);
    v("map", map);
  }
};

/// The best found on the floors of scenarios/library/localization, seed 1: nav2's noise is that of wheels, 0.45 m a
/// metre, and 2,000 particles are 0.3 per cubic cell of 0.5 m, 0.5 m, 10 degrees on a floor of 300 m^2. The product of
/// beams (likelihood_field_prob) was worse: it commits to the first scan at once.
struct AmclTunedConfig : AmclConfig {
  AmclTunedConfig();
};

/// Adaptive Monte Carlo localization as nav2 does it, on the slice of the plan that an occupancy grid would be: planar
/// scans cut from the LiDAR's, a likelihood field, KLD sampling. It starts uniform over free space. Its answer is the
/// mean of the heaviest cluster with the covariance of the whole set; CONVERGED as long as filter.converged_by says so,
/// SEARCHING otherwise, and never LOST. These states are ours: nav2 has none. Throws InputError when there is no plan,
/// no such storey, or no room in it.
[[nodiscard]] std::unique_ptr<Method> make_amcl(const MethodInput& input, const AmclConfig& config = {});

}  // namespace plumbline::slam
