// SPDX-License-Identifier: Apache-2.0
#include "scenarios/score/handover.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace plumbline::scenarios::score {

namespace {

/// A seen patch at the true pose, from above; free space on the left of p0 to p1.
struct Patch {
  Eigen::Vector2d p0, e, n;
  double length = 0.0;
  double z = 0.0;  ///< of its middle
};

Patch place(const slam::WallMatch& match, const Pose& X_WR) {
  const Eigen::Vector3d p0_W = X_WR * match.p0_R, p1_W = X_WR * match.p1_R;
  Patch patch;
  patch.p0 = p0_W.head<2>();
  patch.e = (p1_W - p0_W).head<2>().normalized();
  patch.n = {-patch.e.y(), patch.e.x()};
  patch.length = (p1_W - p0_W).head<2>().norm();
  patch.z = 0.5 * (p0_W.z() + p1_W.z());
  return patch;
}

using Stretch = std::pair<double, double>;

/// What of the patch lies on the face, along the patch; empty stretches where nothing does.
Stretch part_on(const bim::PlanFace& face, const Patch& patch, const StructureRules& rules) {
  constexpr Stretch nothing{0.0, 0.0};
  const double cos_limit = std::cos(rules.wall_angle_deg * std::numbers::pi / 180.0);
  if (patch.n.dot(face.plane_W.n.head<2>()) < cos_limit || patch.z < face.z0 || patch.z > face.z1) return nothing;
  const Eigen::Vector2d middle = patch.p0 + 0.5 * patch.length * patch.e;
  if (std::abs(face.plane_W.distance({middle.x(), middle.y(), patch.z})) > rules.wall_offset_m) return nothing;
  const auto [low, high] = std::minmax({patch.e.dot(face.p0 - patch.p0), patch.e.dot(face.p1 - patch.p0)});
  return {std::max(low, 0.0), std::min(high, patch.length)};
}

double total(std::vector<Stretch> stretches) {
  std::sort(stretches.begin(), stretches.end());
  double sum = 0.0, end = 0.0;
  for (const auto& [low, high] : stretches) {
    sum += std::max(0.0, high - std::max(low, end));
    end = std::max(end, high);
  }
  return sum;
}

/// True for the as-built counterpart of one of the plan's faces with these ids.
bool is_one_of(const bim::PlanFace& built, const std::vector<int>& ids, const bim::Plan& as_planned) {
  return std::any_of(as_planned.faces.begin(), as_planned.faces.end(), [&](const bim::PlanFace& face) {
    return face.wall_id == built.wall_id && face.side == built.side &&
           std::find(ids.begin(), ids.end(), face.id) != ids.end();
  });
}

}  // namespace

std::vector<bool> right_matches(const std::vector<slam::WallMatch>& matches, const Pose& X_WR_true,
                                const bim::Plan& as_planned, const bim::Plan& as_built, const StructureRules& rules) {
  std::vector<bool> right;
  for (const slam::WallMatch& match : matches) {
    const Patch patch = place(match, X_WR_true);
    std::vector<Stretch> parts;
    for (const bim::PlanFace& face : as_built.faces) {
      const Stretch part = part_on(face, patch, rules);
      if (part.second > part.first && is_one_of(face, match.faces, as_planned)) parts.push_back(part);
    }
    right.push_back(total(std::move(parts)) >= rules.wall_overlap * patch.length);
  }
  return right;
}

std::vector<std::string> walls_seen(const std::vector<slam::WallMatch>& matches, const Pose& X_WR_true,
                                    const bim::Plan& as_built, const StructureRules& rules) {
  std::vector<std::string> seen;
  for (const slam::WallMatch& match : matches) {
    const Patch patch = place(match, X_WR_true);
    std::map<std::string, std::vector<Stretch>> parts;  // by wall
    for (const bim::PlanFace& face : as_built.faces) {
      const Stretch part = part_on(face, patch, rules);
      if (part.second > part.first) parts[face.wall_id].push_back(part);
    }
    double most = 0.0;
    seen.emplace_back();
    for (auto& [wall, stretches] : parts) {
      const double length = total(std::move(stretches));
      if (length <= most) continue;
      most = length;
      seen.back() = wall;
    }
  }
  return seen;
}

std::optional<double> handover_precision(const Truth& truth, const std::vector<Belief>& beliefs,
                                         const bim::Plan& as_planned, const bim::Plan& as_built,
                                         const StructureRules& rules) {
  const auto converged = std::find_if(beliefs.begin(), beliefs.end(), [&](const Belief& belief) {
    return belief.state == slam::State::converged && (!truth.set_down || belief.stamp < *truth.set_down);
  });
  if (converged == beliefs.end() || converged->hypotheses.empty()) return std::nullopt;
  const slam::Hypothesis& best =
      *std::max_element(converged->hypotheses.begin(), converged->hypotheses.end(),
                        [](const slam::Hypothesis& a, const slam::Hypothesis& b) { return a.mass < b.mass; });
  if (best.walls.empty()) return std::nullopt;
  const std::vector<bool> right = right_matches(best.walls, truth.at(converged->stamp), as_planned, as_built, rules);
  return static_cast<double>(std::count(right.begin(), right.end(), true)) / static_cast<double>(right.size());
}

}  // namespace plumbline::scenarios::score
