// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/wall_matches.h"

#include <algorithm>
#include <utility>

namespace plumbline::slam {

std::vector<WallMatch> wall_matches(const bim::Plan& plan_W, const StoreyIndex& storey,
                                    const std::vector<WallLink>& links) {
  std::vector<WallMatch> matches;
  for (const WallLink& link : links) {
    WallMatch match{{}, link.observed.p0_R, link.observed.p1_R};
    for (const PlanSegment& segment : storey.segments)
      if (segment.line == link.line)
        match.faces.push_back(plan_W.faces[static_cast<std::size_t>(segment.plan_face)].id);
    std::sort(match.faces.begin(), match.faces.end());
    const Eigen::Vector3d e = match.p1_R - match.p0_R, n = link.observed.plane_R.n;
    if (e.x() * n.y() - e.y() * n.x() < 0.0) std::swap(match.p0_R, match.p1_R);
    matches.push_back(std::move(match));
  }
  return matches;
}

}  // namespace plumbline::slam
