// SPDX-License-Identifier: Apache-2.0
#include "slam/mapping/wall_faces.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace plumbline::slam {

namespace {

/// Walls stand upright: what was seen of one may be too low to tell, and a mirror image is far behind it.
Plane upright(const PlaneNode& wall) {
  const Eigen::Vector3d n = Eigen::Vector3d(wall.plane_F.n.x(), wall.plane_F.n.y(), 0.0).normalized();
  const Eigen::Vector2d middle = 0.5 * (wall.p0 + wall.p1);
  return {n, -n.head<2>().dot(middle)};
}

/// True when `other` is the better known face of the wall that `wall` is a part of: a pane or a leaf set back in it, or
/// the same face found twice.
bool is_part_of(const PlaneNode& wall, const PlaneNode& other, const MirrorGhostConfig& config) {
  constexpr double parallel = 0.99;  // cosine: 8 degrees, as a pane of few points may be off
  if (std::tie(other.observations, wall.id) <= std::tie(wall.observations, other.id)) return false;
  const Eigen::Vector2d along = (other.p1 - other.p0).normalized();
  const Eigen::Vector2d middle = 0.5 * (wall.p0 + wall.p1);
  const double s = along.dot(middle);
  return wall.plane_F.n.dot(other.plane_F.n) > parallel && s > along.dot(other.p0) && s < along.dot(other.p1) &&
         std::abs(upright(other).distance({middle.x(), middle.y(), 0.0})) < config.pane_depth_m;
}

/// Walls are not seen up to the corner where they join, where they are mostly glass or partly hidden.
void reach_corners(std::vector<WallFace>& faces, const MirrorGhostConfig& config) {
  const std::vector<WallFace> seen = faces;
  for (std::size_t f = 0; f < seen.size(); ++f) {
    const WallFace& face = seen[f];
    const Eigen::Vector2d n = face.plane.n.head<2>();
    for (const WallFace& other : seen) {
      const Eigen::Vector2d m = other.plane.n.head<2>();
      const double across = m.dot(face.along);
      if (std::abs(across) < 0.5) continue;  // sine: they are nearer to parallel than 30 degrees
      const double s = -(m.dot(-face.plane.d * n) + other.plane.d) / across;
      const double there = other.along.dot(s * face.along - face.plane.d * n);
      if (there < other.s0 - config.corner_m || there > other.s1 + config.corner_m) continue;
      if (s < face.s0 && s > face.s0 - config.corner_m) faces[f].s0 = std::min(faces[f].s0, s);
      if (s > face.s1 && s < face.s1 + config.corner_m) faces[f].s1 = std::max(faces[f].s1, s);
    }
  }
}

/// An angle that grows with that of v, in [0, 4); quarters are one apart. 0 for the zero vector.
double diamond_angle(const Eigen::Vector2d& v) {
  const double sum = std::abs(v.x()) + std::abs(v.y());
  if (!(sum > 0.0)) return 0.0;
  const double t = v.y() / sum;
  if (v.x() < 0.0) return 2.0 - t;
  return t < 0.0 ? 4.0 + t : t;
}

}  // namespace

std::vector<WallFace> wall_faces(std::span<const PlaneNode> walls, const MirrorGhostConfig& config) {
  std::vector<WallFace> faces;
  for (const PlaneNode& wall : walls) {
    const auto holds = [&](const PlaneNode& other) { return is_part_of(wall, other, config); };
    if (std::any_of(walls.begin(), walls.end(), holds)) continue;
    WallFace face{upright(wall), (wall.p1 - wall.p0).normalized(), 0.0, 0.0, wall.z0, wall.z1};
    face.s0 = face.seen_s0 = face.along.dot(wall.p0);
    face.s1 = face.seen_s1 = face.along.dot(wall.p1);
    faces.push_back(face);
  }
  reach_corners(faces, config);
  return faces;
}

FacesNear::FacesNear(std::span<const WallFace> faces, double reach_m) : size_m_(std::max(0.5, 2.0 * reach_m)) {
  // A point within reach is nearer to a sample than a square is wide, so in one of the nine squares round it.
  const double step_m = 0.5 * size_m_;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto samples = static_cast<std::size_t>((faces[f].s1 - faces[f].s0) / step_m) + 2;
    for (std::size_t k = 0; k < samples; ++k) {
      const double s = std::min(faces[f].s0 + step_m * static_cast<double>(k), faces[f].s1);
      const VoxelKey middle = square_of(faces[f].at(s));
      for (int dx = -1; dx <= 1; ++dx)
        for (int dy = -1; dy <= 1; ++dy) {
          const auto slot = static_cast<std::size_t>(squares_.insert({middle.x + dx, middle.y + dy, 0}));
          if (slot == faces_.size()) faces_.emplace_back();
          if (faces_[slot].empty() || faces_[slot].back() != f) faces_[slot].push_back(static_cast<std::uint32_t>(f));
        }
    }
  }
}

std::span<const std::uint32_t> FacesNear::of(const Eigen::Vector3d& p_F) const {
  const int slot = squares_.find(square_of(p_F.head<2>()));
  if (slot < 0) return {};
  return faces_[static_cast<std::size_t>(slot)];
}

VoxelKey FacesNear::square_of(const Eigen::Vector2d& p_F) const {
  return VoxelKey::of({p_F.x(), p_F.y(), 0.0}, size_m_);
}

FacesInView::FacesInView(std::span<const WallFace> faces, const Eigen::Vector3d& from_F) : from_F_(from_F.head<2>()) {
  constexpr double beside_m = 1e-6;  // so near to its plane a face may begin in any direction
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const double from_m = faces[f].plane.distance(from_F);
    if (from_m <= 0.0) continue;
    Eigen::Vector2d a = faces[f].at(faces[f].s0) - from_F_, b = faces[f].at(faces[f].s1) - from_F_;
    if (a.x() * b.y() - a.y() * b.x() < 0.0) std::swap(a, b);
    // One sector more at either end takes up what rounding does.
    const int first = from_m < beside_m ? 0 : static_cast<int>(diamond_angle(a) * (sectors / 4)) - 1;
    int last = from_m < beside_m ? sectors - 1 : static_cast<int>(diamond_angle(b) * (sectors / 4)) + 1;
    if (last < first) last += sectors;
    last = std::min(last, first + sectors - 1);
    for (int k = first; k <= last; ++k)
      faces_[static_cast<std::size_t>((k + sectors) % sectors)].push_back({static_cast<std::uint32_t>(f), from_m});
  }
}

std::span<const FacesInView::Face> FacesInView::towards(const Eigen::Vector3d& p_F) const {
  const double angle = diamond_angle(p_F.head<2>() - from_F_);
  return faces_[static_cast<std::size_t>(angle * (sectors / 4)) % sectors];
}

}  // namespace plumbline::slam
