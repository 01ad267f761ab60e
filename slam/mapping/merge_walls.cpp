// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "slam/graph/factors.h"
#include "slam/mapping/wall_layer.h"

namespace plumbline::slam {

int WallLayer::merge_duplicates(Graph& graph) {
  int merged = 0;
  std::vector<DuplicateFactor> open;
  for (const DuplicateFactor& f : graph.duplicate_factors) {
    PlaneVertex& kept = graph.planes[static_cast<std::size_t>(f.a)];
    PlaneVertex& gone = graph.planes[static_cast<std::size_t>(f.b)];
    if (kept.merged_into >= 0 || gone.merged_into >= 0) continue;
    const Eigen::Vector4d e = duplicate_residual(kept.plane_M, gone.plane_M, f.anchor_M).e;
    if (std::abs(e(3)) > config_.merge_offset_m || e.head<3>().norm() > config_.merge_angle_rad) {
      open.push_back(f);
      continue;
    }
    gone.merged_into = f.a;
    first_seen_m_[static_cast<std::size_t>(f.a)] =
        std::min(first_seen_m_[static_cast<std::size_t>(f.a)], first_seen_m_[static_cast<std::size_t>(f.b)]);
    last_seen_m_[static_cast<std::size_t>(f.a)] =
        std::max(last_seen_m_[static_cast<std::size_t>(f.a)], last_seen_m_[static_cast<std::size_t>(f.b)]);
    // What stands apart from the one stands apart from both.
    for (const auto& [pair, scans] : std::map(separation_votes_))
      if (pair.first == f.b || pair.second == f.b)
        separation_votes_[std::minmax(f.a, pair.first == f.b ? pair.second : pair.first)] += scans;
    for (const auto& pair : std::set(far_separations_))
      if (pair.first == f.b || pair.second == f.b)
        far_separations_.insert(std::minmax(f.a, pair.first == f.b ? pair.second : pair.first));
    for (PlaneFactor& factor : graph.plane_factors)
      if (factor.plane == f.b) factor.plane = f.a;
    ++merged;
  }
  graph.duplicate_factors = std::move(open);
  if (merged > 0) unfreeze_extents();
  return merged;
}

}  // namespace plumbline::slam
