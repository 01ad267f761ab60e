// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>

#include "scenarios/score/structure.h"

namespace plumbline::scenarios::score {

namespace {

/// Part of a face, from and to along it, m.
struct Stretch {
  double low = 0.0;
  double high = 0.0;
  [[nodiscard]] double length() const { return high - low; }
};

struct Candidate {
  double offset = 0.0;
  int plane = 0;  ///< index into Estimate::planes
  int face = 0;   ///< index into Plan::faces
  Stretch stretch;
};

/// Position of p along a face from p0, m.
double along(const bim::PlanFace& face, const Eigen::Vector2d& p) {
  return (p - face.p0).dot((face.p1 - face.p0).normalized());
}

double length(const bim::PlanFace& face) { return (face.p1 - face.p0).norm(); }

/// A found wall in W.
struct PlacedWall {
  Eigen::Vector3d n_W;
  Eigen::Vector3d p0_W, p1_W;
};

PlacedWall place(const slam::PlaneNode& node, const Pose& X_WF) {
  const double z = 0.5 * (node.z0 + node.z1);
  return {X_WF.q * node.plane_F.n, X_WF * Eigen::Vector3d(node.p0.x(), node.p0.y(), z),
          X_WF * Eigen::Vector3d(node.p1.x(), node.p1.y(), z)};
}

/// The stretch of the face that is this wall, and how far off it is; nothing when they do not match.
std::optional<std::pair<double, Stretch>> match(const PlacedWall& wall, const bim::PlanFace& face,
                                                const StructureRules& rules) {
  const double cos_limit = std::cos(rules.wall_angle_deg * std::numbers::pi / 180.0);
  if (wall.n_W.dot(face.plane_W.n) < cos_limit) return std::nullopt;
  const Eigen::Vector3d middle = 0.5 * (wall.p0_W + wall.p1_W);
  const double offset = std::abs(face.plane_W.distance(middle));
  if (offset > rules.wall_offset_m || middle.z() < face.z0 || middle.z() > face.z1) return std::nullopt;
  const auto [low, high] = std::minmax({along(face, wall.p0_W.head<2>()), along(face, wall.p1_W.head<2>())});
  const Stretch shared{std::max(low, 0.0), std::min(high, length(face))};
  if (shared.length() <= 0.0 || shared.length() < rules.wall_overlap * (high - low)) return std::nullopt;
  return std::pair{offset, shared};
}

/// True when the stretch is, by more than half of the shorter one, a stretch that was matched before.
bool is_taken(const std::vector<Stretch>& taken, const Stretch& stretch) {
  return std::any_of(taken.begin(), taken.end(), [&](const Stretch& other) {
    const double shared = std::min(other.high, stretch.high) - std::max(other.low, stretch.low);
    return shared > 0.5 * std::min(other.length(), stretch.length());
  });
}

/// A face is seen when enough of the truly hit points lie on it, far enough apart.
bool is_seen(const bim::PlanFace& face, const std::vector<Eigen::Vector3d>& surface_W, const StructureRules& rules) {
  int count = 0;
  double low = length(face);
  double high = 0.0;
  for (const Eigen::Vector3d& p : surface_W) {
    if (std::abs(face.plane_W.distance(p)) > rules.seen_within_m || p.z() < face.z0 || p.z() > face.z1) continue;
    const double s = along(face, p.head<2>());
    if (s < 0.0 || s > length(face)) continue;
    low = std::min(low, s);
    high = std::max(high, s);
    ++count;
  }
  return count >= rules.seen_points && high - low >= rules.seen_length_m;
}

}  // namespace

WallScore score_walls(const slam::Estimate& estimate, const Pose& X_WF, const bim::Plan& as_built,
                      const std::vector<Eigen::Vector3d>& surface_W, const StructureRules& rules) {
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < estimate.planes.size(); ++i) {
    const PlacedWall wall = place(estimate.planes[i], X_WF);
    for (std::size_t j = 0; j < as_built.faces.size(); ++j) {
      if (const auto found = match(wall, as_built.faces[j], rules))
        candidates.push_back({found->first, static_cast<int>(i), static_cast<int>(j), found->second});
    }
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return std::tie(a.offset, a.plane, a.face) < std::tie(b.offset, b.plane, b.face);
  });

  WallScore score;
  score.face_of_plane.assign(estimate.planes.size(), -1);
  std::vector<std::vector<Stretch>> taken(as_built.faces.size());
  int matched = 0;
  for (const Candidate& c : candidates) {
    int& face_id = score.face_of_plane[static_cast<std::size_t>(c.plane)];
    const auto face = static_cast<std::size_t>(c.face);
    if (face_id >= 0 || is_taken(taken[face], c.stretch)) continue;
    face_id = as_built.faces[face].id;
    taken[face].push_back(c.stretch);
    ++matched;
  }
  int seen = 0;
  int seen_matched = 0;
  for (std::size_t j = 0; j < as_built.faces.size(); ++j) {
    if (!is_seen(as_built.faces[j], surface_W, rules)) continue;
    ++seen;
    if (!taken[j].empty()) ++seen_matched;
  }
  score.precision = static_cast<double>(matched) / static_cast<double>(estimate.planes.size());
  if (seen > 0) score.recall = static_cast<double>(seen_matched) / seen;
  return score;
}

}  // namespace plumbline::scenarios::score
