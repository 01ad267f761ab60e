// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "scenarios/metrics/structure.h"

namespace plumbline::scenarios::score {

namespace {

/// Part of a face, from and to along it, m.
struct Stretch {
  double low = 0.0;
  double high = 0.0;
  [[nodiscard]] double length() const { return high - low; }
};

/// A face that a found wall may be, or be part of.
struct Part {
  double offset = 0.0;
  int face = 0;     ///< index into Plan::faces
  Stretch on_face;  ///< where they are beside each other, along the face
  Stretch on_wall;  ///< the same, along the found wall
};

/// A found wall with its parts, the nearest first.
struct Candidate {
  int plane = 0;  ///< index into Estimate::planes
  double length = 0.0;
  std::vector<Part> parts;
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

/// The stretch of the face that lies beside this wall; nothing where they are not in one plane.
std::optional<Part> beside(const PlacedWall& wall, const bim::PlanFace& face, const StructureRules& rules) {
  const double cos_limit = std::cos(rules.wall_angle_deg * std::numbers::pi / 180.0);
  if (wall.n_W.dot(face.plane_W.n) < cos_limit) return std::nullopt;
  const Eigen::Vector3d middle = 0.5 * (wall.p0_W + wall.p1_W);
  const double offset = std::abs(face.plane_W.distance(middle));
  if (offset > rules.wall_offset_m || middle.z() < face.z0 || middle.z() > face.z1) return std::nullopt;
  const double s0 = along(face, wall.p0_W.head<2>()), s1 = along(face, wall.p1_W.head<2>());
  const Stretch shared{std::max(std::min(s0, s1), 0.0), std::min(std::max(s0, s1), length(face))};
  if (shared.length() <= 0.0) return std::nullopt;
  const double low = s0 <= s1 ? shared.low - s0 : s0 - shared.high;
  return Part{offset, 0, shared, {low, low + shared.length()}};
}

bool overlap(const Stretch& a, const Stretch& b) {
  return std::min(a.high, b.high) - std::max(a.low, b.low) > 0.5 * std::min(a.length(), b.length());
}

/// True where more than half of the found wall lies on stretches that other walls were matched with.
bool is_duplicate(const Candidate& wall, const std::vector<std::vector<Stretch>>& taken) {
  double shared_m = 0.0;
  for (const Part& part : wall.parts)
    for (const Stretch& other : taken[static_cast<std::size_t>(part.face)])
      shared_m += std::max(0.0, std::min(other.high, part.on_face.high) - std::max(other.low, part.on_face.low));
  return shared_m > 0.5 * wall.length;
}

/// What of a found wall's parts is not some other wall's, and of those one over the other the nearest only.
std::vector<Part> free_parts(const Candidate& wall, const std::vector<std::vector<Stretch>>& taken) {
  std::vector<Part> free;
  for (const Part& part : wall.parts) {
    const auto over = [&](const Part& other) { return overlap(other.on_wall, part.on_wall); };
    const auto is_it = [&](const Stretch& other) { return overlap(other, part.on_face); };
    const std::vector<Stretch>& others = taken[static_cast<std::size_t>(part.face)];
    if (std::none_of(free.begin(), free.end(), over) && std::none_of(others.begin(), others.end(), is_it))
      free.push_back(part);
  }
  return free;
}

std::vector<Candidate> candidates_of(const slam::Estimate& estimate, const Pose& X_WF, const bim::Plan& as_built,
                                     const StructureRules& rules) {
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < estimate.planes.size(); ++i) {
    const PlacedWall wall = place(estimate.planes[i], X_WF);
    Candidate candidate{static_cast<int>(i), (wall.p1_W - wall.p0_W).head<2>().norm(), {}};
    for (std::size_t j = 0; j < as_built.faces.size(); ++j)
      if (std::optional<Part> part = beside(wall, as_built.faces[j], rules)) {
        part->face = static_cast<int>(j);
        // A wall that ends a little beyond its corner is no part of what follows there.
        const double least = std::min(rules.seen_length_m, rules.wall_overlap * candidate.length);
        if (part->on_face.length() >= std::min(least, length(as_built.faces[j]))) candidate.parts.push_back(*part);
      }
    std::stable_sort(candidate.parts.begin(), candidate.parts.end(),
                     [](const Part& a, const Part& b) { return a.offset < b.offset; });
    if (!candidate.parts.empty()) candidates.push_back(std::move(candidate));
  }
  std::stable_sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.parts.front().offset < b.parts.front().offset;
  });
  return candidates;
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
  WallScore score;
  score.faces_of_plane.resize(estimate.planes.size());
  std::vector<std::vector<Stretch>> taken(as_built.faces.size());
  int matched = 0;
  for (const Candidate& wall : candidates_of(estimate, X_WF, as_built, rules)) {
    std::vector<Part> parts = free_parts(wall, taken);
    const double shared = std::accumulate(parts.begin(), parts.end(), 0.0,
                                          [](double sum, const Part& part) { return sum + part.on_face.length(); });
    if (parts.empty() || shared < rules.wall_overlap * wall.length) {
      score.duplicates += is_duplicate(wall, taken);
      continue;
    }
    std::stable_sort(parts.begin(), parts.end(),
                     [](const Part& a, const Part& b) { return a.on_face.length() > b.on_face.length(); });
    for (const Part& part : parts) {
      const auto face = static_cast<std::size_t>(part.face);
      score.faces_of_plane[static_cast<std::size_t>(wall.plane)].push_back(as_built.faces[face].id);
      taken[face].push_back(part.on_face);
    }
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
