// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <tuple>

#include "scenarios/metrics/storey.h"
#include "scenarios/metrics/structure.h"

namespace plumbline::scenarios::score {

namespace {

/// A found floor and a storey at its height.
struct Candidate {
  double off_m = 0.0;
  std::size_t floor = 0, storey = 0;
};

bool stood_on(const bim::PlanStorey& storey, const Truth& truth, const StructureRules& rules) {
  const auto needed = static_cast<slam::Nanoseconds>(std::llround(rules.visit_s * 1e9));
  slam::Nanoseconds since = -1;
  for (const slam::StampedPose& pose : truth.poses_W) {
    if (std::abs(pose.X_FR.t.z() - base_height_m() - storey.elevation_m) > rules.storey_m) {
      since = -1;
      continue;
    }
    if (since < 0) since = pose.stamp;
    if (pose.stamp - since >= needed) return true;
  }
  return false;
}

}  // namespace

StoreyScore score_storeys(const slam::Estimate& estimate, const Pose& X_WF, const bim::Plan& as_built,
                          const Truth& truth, const StructureRules& rules) {
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < estimate.floors.size(); ++i)
    for (std::size_t j = 0; j < as_built.storeys.size(); ++j) {
      const double off_m = std::abs((X_WF * estimate.floors[i].center_F).z() - as_built.storeys[j].elevation_m);
      if (off_m <= rules.storey_m) candidates.push_back({off_m, i, j});
    }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return std::tie(a.off_m, a.floor, a.storey) < std::tie(b.off_m, b.floor, b.storey);
  });
  std::vector<bool> matched(estimate.floors.size(), false), taken(as_built.storeys.size(), false);
  StoreyScore score;
  for (const Candidate& c : candidates) {
    if (matched[c.floor] || taken[c.storey]) continue;
    matched[c.floor] = taken[c.storey] = true;
    ++score.matched;
  }
  int found = 0;
  for (std::size_t j = 0; j < as_built.storeys.size(); ++j) {
    if (!stood_on(as_built.storeys[j], truth, rules)) continue;
    ++score.visited;
    found += taken[j];
  }
  score.found = static_cast<int>(estimate.floors.size());
  if (score.found > 0) score.precision = static_cast<double>(score.matched) / score.found;
  if (score.visited > 0) score.recall = static_cast<double>(found) / score.visited;
  return score;
}

}  // namespace plumbline::scenarios::score
