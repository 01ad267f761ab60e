// SPDX-License-Identifier: Apache-2.0
#include "slam/mapping/wall_layer.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "bim/geometry/interval.h"
#include "slam/graph/factors.h"
#include "slam/mapping/floor_layer.h"
#include "slam/planes/forms.h"

namespace plumbline::slam {

namespace {

constexpr double same_side = 0.9;  ///< cosine between the normals of faces that may be one
/// Of observations that must not count: no weight, but positive definite. 1 mm counts as 32 m.
constexpr double released_weight = 1e-9;

PlaneKind kind_of(const PlaneObservation& seen) {
  if (seen.vertical) return PlaneKind::wall;
  return seen.plane_R.n.z() > 0.0 ? PlaneKind::floor : PlaneKind::ceiling;
}

/// Direction of a wall in plan: its horizontal tangent.
Eigen::Vector2d along(const Plane& plane) { return Eigen::Vector2d(-plane.n.y(), plane.n.x()).normalized(); }

Interval interval(const Eigen::Vector2d& direction, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  Interval i;
  i.add(direction.dot(a));
  i.add(direction.dot(b));
  return i;
}

/// Between an observation from X_MR and a known wall, along it, m.
double gap_along(const PlaneNode& known, const Pose& X_MR, const PlaneObservation& seen) {
  const Eigen::Vector2d t = along(known.plane_F);
  return gap(interval(t, (X_MR * seen.p0_R).head<2>(), (X_MR * seen.p1_R).head<2>()), interval(t, known.p0, known.p1));
}

Eigen::Vector2d middle(const PlaneNode& wall) { return 0.5 * (wall.p0 + wall.p1); }

/// Do two vertices share so much of the shorter one's length and of the lower one's height?
bool overlap(const PlaneNode& a, const PlaneNode& b, double share) {
  const Eigen::Vector2d t = along(a.plane_F);
  const Interval ia = interval(t, a.p0, a.p1), ib = interval(t, b.p0, b.p1);
  if (-gap(ia, ib) < share * std::min(ia.length(), ib.length())) return false;
  const Interval za{a.z0, a.z1}, zb{b.z0, b.z1};
  return -gap(za, zb) >= share * std::min(za.length(), zb.length());
}

/// Distance between two vertices of one side, where the shorter one is, m.
double offset_between(const PlaneNode& a, const PlaneNode& b) {
  const Eigen::Vector2d t = along(a.plane_F);
  const bool b_shorter = interval(t, b.p0, b.p1).length() < interval(t, a.p0, a.p1).length();
  const PlaneNode &shorter = b_shorter ? b : a, &longer = b_shorter ? a : b;
  const Eigen::Vector3d p(middle(shorter).x(), middle(shorter).y(), 0.5 * (shorter.z0 + shorter.z1));
  return longer.plane_F.distance(p) - shorter.plane_F.distance(p);
}

/// Do two vertices overlap so much, on the same side and so near, that one would hide the other?
bool is_same_face(const PlaneNode& a, const PlaneNode& b, const WallLayerConfig& config) {
  return a.plane_F.n.dot(b.plane_F.n) >= std::cos(config.duplicate_angle_rad) &&
         overlap(a, b, config.duplicate_overlap) && std::abs(offset_between(a, b)) < config.duplicate_offset_m;
}

/// The wall of that id, or null; walls by id.
const PlaneNode* find(std::span<const PlaneNode> walls, int id) {
  const auto at = std::partition_point(walls.begin(), walls.end(), [&](const PlaneNode& w) { return w.id < id; });
  return at != walls.end() && at->id == id ? &*at : nullptr;
}

/// Variance of a plane's offset at p, m^2.
double offset_variance(const PlaneObservation& seen, const Eigen::Vector3d& p_R) {
  const Tangents t = plane_tangents(seen.plane_R.n);
  const Eigen::Vector3d J(t.u.dot(p_R), t.v.dot(p_R), 1.0);
  return J.dot(seen.covariance * J);
}

/// Are two wall patches of one scan two faces? Compared at the middle of either: the tilt of a low strip, such as a
/// sill, hardly determines where its plane is above it.
bool are_separate_faces(const PlaneObservation& a, const PlaneObservation& b, double chi2) {
  if (!a.vertical || !b.vertical) return false;
  const auto are_separate_at = [&](const Eigen::Vector3d& p_R) {
    const double offset = a.plane_R.distance(p_R) - b.plane_R.distance(p_R);
    return offset * offset > chi2 * (offset_variance(a, p_R) + offset_variance(b, p_R));
  };
  return are_separate_at(a.centroid_R) || are_separate_at(b.centroid_R);
}

}  // namespace

std::vector<int> WallLayer::observe(Graph& graph, std::span<const PlaneObservation> seen, double walked_m) {
  const int keyframe = static_cast<int>(graph.keyframes.size()) - 1;
  const Pose& X_MR = graph.keyframes.back().X_MR;
  std::vector<int> ids = match(graph, seen, walked_m);
  for (std::size_t k = 0; k < seen.size(); ++k) {
    const PlaneObservation& observation = seen[k];
    if (ids[k] < 0) {
      ids[k] = static_cast<int>(graph.planes.size());
      graph.planes.push_back({X_MR * observation.plane_R, kind_of(observation), graph.keyframes.back().storey, -1});
      first_seen_m_.push_back(walked_m);
      last_seen_m_.push_back(walked_m);
    }
    const Eigen::Matrix3d covariance = config_.information > 0.0
                                           ? Eigen::Matrix3d(Eigen::Matrix3d::Identity() / config_.information)
                                           : observation.covariance;
    const Eigen::Matrix3d information =
        covariance.llt().solve(Eigen::Matrix3d::Identity()).selfadjointView<Eigen::Lower>();
    graph.plane_factors.push_back({keyframe, ids[k], observation.plane_R, information});
    patches_.push_back({observation.p0_R, observation.p1_R, observation.z0, observation.z1});
  }
  for (const int id : ids) last_seen_m_[static_cast<std::size_t>(id)] = walked_m;
  if (config_.association == Association::mahalanobis) record_separations(seen, ids);
  return ids;
}

std::vector<int> WallLayer::match(const Graph& graph, std::span<const PlaneObservation> seen, double walked_m) const {
  struct Candidate {
    double normalized_mahalanobis2 = 0.0;
    std::size_t seen = 0;
    int plane = 0;
  };
  const int storey = graph.keyframes.back().storey;
  const bool as_printed = config_.association == Association::angles;
  std::vector<Candidate> candidates;
  const std::vector<PlaneNode> known = extents(graph);
  for (std::size_t k = 0; k < seen.size(); ++k)
    for (const PlaneNode& node : known) {
      const PlaneVertex& plane = graph.planes[static_cast<std::size_t>(node.id)];
      if (plane.released) continue;
      if (plane.merged_into >= 0 || plane.kind != kind_of(seen[k]) || plane.storey != storey) continue;
      const double normalized_mahalanobis2 = as_printed ? paper_normalized_distance2(graph, node, seen[k])
                                                        : this->normalized_mahalanobis2(graph, node, seen[k], walked_m);
      if (normalized_mahalanobis2 < 1.0) candidates.push_back({normalized_mahalanobis2, k, node.id});
    }
  std::stable_sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.normalized_mahalanobis2 < b.normalized_mahalanobis2;
  });
  std::vector<int> ids(seen.size(), -1);
  for (const Candidate& c : candidates) {
    if (ids[c.seen] >= 0) continue;
    bool fits = true;
    for (std::size_t k = 0; k < seen.size() && fits && !as_printed; ++k)
      fits = ids[k] != c.plane || !are_separate_faces(seen[k], seen[c.seen], config_.separate_faces_chi2);
    if (fits) ids[c.seen] = c.plane;
  }
  return ids;
}

void WallLayer::release_floors(Graph& graph, int storey, int first) {
  std::vector<bool> found(graph.planes.size(), false);
  for (PlaneFactor& factor : graph.plane_factors) {
    const auto id = static_cast<std::size_t>(factor.plane);
    PlaneVertex& plane = graph.planes[id];
    if (plane.kind != PlaneKind::floor || plane.storey != storey) continue;
    if (factor.keyframe >= first) plane.released = true;
    if (found[id] && factor.keyframe >= first) factor.information *= released_weight;
    found[id] = true;
  }
}

void WallLayer::record_separations(std::span<const PlaneObservation> seen, std::span<const int> ids) {
  for (std::size_t i = 0; i < seen.size(); ++i)
    for (std::size_t j = i + 1; j < seen.size(); ++j) {
      if (ids[i] == ids[j] || !seen[i].vertical || !seen[j].vertical) continue;
      if (seen[i].plane_R.n.dot(seen[j].plane_R.n) < same_side) continue;
      const double offset = std::abs(seen[i].plane_R.distance(seen[j].centroid_R));
      if (offset <= 2.0 * config_.duplicate_offset_m)
        separation_votes_[std::minmax(ids[i], ids[j])] +=
            are_separate_faces(seen[i], seen[j], config_.separate_faces_chi2) ? 1 : -1;
      else if (offset <= config_.room_offset_m)
        far_separations_.insert(std::minmax(ids[i], ids[j]));
    }
}

bool WallLayer::known_separate(int a, int b) const {
  const auto found = separation_votes_.find(std::minmax(a, b));
  return found != separation_votes_.end() && found->second > 0;
}

double WallLayer::normalized_mahalanobis2(const Graph& graph, const PlaneNode& known, const PlaneObservation& seen,
                                          double walked_m) const {
  constexpr double no_match = 2.0;
  const KeyframeVertex& keyframe = graph.keyframes.back();
  const PlaneVertex& plane = graph.planes[static_cast<std::size_t>(known.id)];
  const PlaneResidual r = plane_residual(keyframe.X_MR, plane.plane_M, seen.plane_R);
  if ((keyframe.X_MR.q * seen.plane_R.n).dot(plane.plane_M.n) < same_side) return no_match;
  if (plane.kind != PlaneKind::wall) {
    const bool near = std::abs(r.e.z()) < config_.floor_offset_m && r.e.head<2>().norm() < config_.floor_angle_rad;
    return near ? 0.0 : no_match;
  }
  if (gap_along(known, keyframe.X_MR, seen) > config_.max_gap_m) return no_match;
  // A wall is seen at the robot's height. One of another storey stands a little aside, and would tilt it.
  const double z = keyframe.X_MR.t.z();
  const bool is_beside = known.z0 <= z && z <= known.z1;
  if (!is_beside && gap({z + seen.z0, z + seen.z1}, {known.z0, known.z1}) > 0.0) return no_match;
  const double walked = walked_m - last_seen_m_[static_cast<std::size_t>(known.id)];
  const double sigma_m = config_.drift_m + config_.drift_per_m * walked;
  const double sigma_rad = config_.drift_rad + config_.drift_rad_per_m * walked;
  Vector6d drift;
  drift << Eigen::Vector3d::Constant(sigma_m * sigma_m), Eigen::Vector3d::Constant(sigma_rad * sigma_rad);
  const Eigen::Matrix3d S = seen.covariance + r.J_pose * drift.asDiagonal() * r.J_pose.transpose();
  return r.e.dot(S.llt().solve(r.e)) / config_.gate_chi2;
}

// The papers call it a Mahalanobis distance; their code's covariance is the identity [lsg2022].
double WallLayer::paper_normalized_distance2(const Graph& graph, const PlaneNode& known,
                                             const PlaneObservation& seen) const {
  constexpr double no_match = 2.0;
  const KeyframeVertex& keyframe = graph.keyframes.back();
  const Plane& plane_M = graph.planes[static_cast<std::size_t>(known.id)].plane_M;
  if (axis_of(keyframe.X_MR.q * seen.plane_R.n) != axis_of(plane_M.n)) return no_match;
  const double gate = seen.points <= config_.angles_few ? config_.angles_gate_few : config_.angles_gate;
  const double e = angle_difference(keyframe.X_MR.inverse() * plane_M, seen.plane_R).norm();
  if (seen.vertical && gap_along(known, keyframe.X_MR, seen) > config_.max_gap_m) return no_match;
  return e * e / (gate * gate);
}

void WallLayer::freeze_extents(const Graph& graph, int first) {
  frozen_extents_.resize(graph.planes.size());
  for (; frozen_factors_ < graph.plane_factors.size(); ++frozen_factors_) {
    const PlaneFactor& factor = graph.plane_factors[frozen_factors_];
    if (factor.keyframe >= first) return;
    const Pose& X_MR = graph.keyframes[static_cast<std::size_t>(factor.keyframe)].X_MR;
    const Patch& patch = patches_[frozen_factors_];
    Extent& known = frozen_extents_[static_cast<std::size_t>(factor.plane)];
    const int seen = known.observations;
    const Eigen::Vector2d t = along(graph.planes[static_cast<std::size_t>(factor.plane)].plane_M);
    for (const Eigen::Vector3d& p_R : {patch.p0_R, patch.p1_R}) {
      const Eigen::Vector2d p = (X_MR * p_R).head<2>();
      const bool none = known.observations == 0;
      if (none || t.dot(p) < t.dot(known.low_M)) known.low_M = p;
      if (none || t.dot(p) > t.dot(known.high_M)) known.high_M = p;
      known.z0 = none ? X_MR.t.z() + patch.z0 : std::min(known.z0, X_MR.t.z() + patch.z0);
      known.z1 = none ? X_MR.t.z() + patch.z1 : std::max(known.z1, X_MR.t.z() + patch.z1);
      known.observations = std::max(known.observations, 1);
    }
    known.observations = seen + 1;
  }
}

void WallLayer::unfreeze_extents() {
  frozen_extents_.clear();
  frozen_factors_ = 0;
}

std::vector<PlaneNode> WallLayer::extents(const Graph& graph) const {
  std::vector<Interval> s(graph.planes.size()), z(graph.planes.size());
  std::vector<int> count(graph.planes.size(), 0);
  for (std::size_t id = 0; id < frozen_extents_.size(); ++id) {
    const Extent& known = frozen_extents_[id];
    count[id] = known.observations;
    if (known.observations == 0) continue;
    const Eigen::Vector2d t = along(graph.planes[id].plane_M);
    s[id] = interval(t, known.low_M, known.high_M);
    z[id] = {known.z0, known.z1};
  }
  for (std::size_t f = frozen_factors_; f < graph.plane_factors.size(); ++f) {
    const PlaneFactor& factor = graph.plane_factors[f];
    const auto id = static_cast<std::size_t>(factor.plane);
    const Pose& X_MR = graph.keyframes[static_cast<std::size_t>(factor.keyframe)].X_MR;
    const Eigen::Vector2d t = along(graph.planes[id].plane_M);
    s[id].add(t.dot((X_MR * patches_[f].p0_R).head<2>()));
    s[id].add(t.dot((X_MR * patches_[f].p1_R).head<2>()));
    z[id].add(X_MR.t.z() + patches_[f].z0);
    z[id].add(X_MR.t.z() + patches_[f].z1);
    ++count[id];
  }
  std::vector<PlaneNode> nodes(graph.planes.size());
  for (std::size_t id = 0; id < nodes.size(); ++id) {
    PlaneNode& node = nodes[id];
    node.id = static_cast<int>(id);
    node.plane_F = graph.planes[id].plane_M;
    node.observations = count[id];
    if (count[id] == 0) continue;
    node.z0 = z[id].low;
    node.z1 = z[id].high;
    if (graph.planes[id].kind != PlaneKind::wall) continue;
    const Eigen::Vector2d t = along(node.plane_F);
    const Eigen::Vector2d m = node.plane_F.n.head<2>();
    // Trace of the plane at the middle of what was seen of it.
    const double offset = (node.plane_F.d + node.plane_F.n.z() * 0.5 * (node.z0 + node.z1)) / m.squaredNorm();
    node.p0 = t * s[id].low - m * offset;
    node.p1 = t * s[id].high - m * offset;
  }
  return nodes;
}

std::vector<PlaneNode> WallLayer::seen_now(const Graph& graph) const {
  const int newest = static_cast<int>(graph.keyframes.size()) - 1;
  const Pose& X_MR = graph.keyframes.back().X_MR;
  std::vector<PlaneNode> nodes;
  for (std::size_t f = graph.plane_factors.size(); f > 0 && graph.plane_factors[f - 1].keyframe == newest; --f) {
    const int id = graph.plane_factors[f - 1].plane;
    const Patch& patch = patches_[f - 1];
    const PlaneVertex& plane = graph.planes[static_cast<std::size_t>(id)];
    if (plane.kind != PlaneKind::wall) continue;
    nodes.push_back({id, plane.plane_M, (X_MR * patch.p0_R).head<2>(), (X_MR * patch.p1_R).head<2>(),
                     X_MR.t.z() + patch.z0, X_MR.t.z() + patch.z1, 1});
  }
  return nodes;
}

std::vector<PlaneNode> WallLayer::walls(const Graph& graph, int storey) const {
  const int floor = floor_plane_of(graph, storey);
  std::vector<PlaneNode> walls;
  for (PlaneNode& node : extents(graph)) {
    const PlaneVertex& plane = graph.planes[static_cast<std::size_t>(node.id)];
    if (plane.kind != PlaneKind::wall || plane.storey != storey) continue;
    if (node.observations < config_.min_observations || (node.p1 - node.p0).norm() < config_.min_length_m) continue;
    if (floor >= 0) {
      const Plane& floor_M = graph.planes[static_cast<std::size_t>(floor)].plane_M;
      const double floor_z = height_at(floor_M, middle(node));
      if (node.z1 - floor_z < config_.min_top_m) continue;
      node.z0 = std::max(node.z0, floor_z);  // down a stairwell it is the wall of the storey below
    }
    walls.push_back(node);
  }
  return walls;
}

bool WallLayer::find_duplicates(Graph& graph, int storey) const {
  const std::vector<PlaneNode> nodes = walls(graph, storey);
  bool found = false;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (std::size_t j = i + 1; j < nodes.size(); ++j)
      if (is_same_face(nodes[i], nodes[j], config_) && !known_separate(nodes[i].id, nodes[j].id))
        found |= add_duplicate(graph, nodes[i], nodes[j]);
  return found;
}

bool WallLayer::add_duplicate(Graph& graph, const PlaneNode& a, const PlaneNode& b) const {
  if (b.id < a.id) return add_duplicate(graph, b, a);
  const bool known = std::any_of(graph.duplicate_factors.begin(), graph.duplicate_factors.end(),
                                 [&](const DuplicateFactor& f) { return f.a == a.id && f.b == b.id; });
  if (known) return false;
  const Eigen::Vector2d p = 0.5 * (middle(a) + middle(b));
  const double z = 0.25 * (a.z0 + a.z1 + b.z0 + b.z1);
  graph.duplicate_factors.push_back(
      {a.id, b.id, {p.x(), p.y(), z}, config_.duplicate_sigma_rad, config_.duplicate_sigma_m});
  return true;
}

double WallLayer::room_normalized_mahalanobis2(std::span<const PlaneNode> walls, int a, int b) const {
  constexpr double no_match = 2.0;
  const PlaneNode *const p = find(walls, a), *const q = find(walls, b);
  if (p == nullptr || q == nullptr || known_separate(a, b) || far_separations_.contains(std::minmax(a, b)))
    return no_match;
  if (p->plane_F.n.dot(q->plane_F.n) < same_side || !overlap(*p, *q, config_.duplicate_overlap)) return no_match;
  const auto way = [](const std::vector<double>& seen_m, int id) { return seen_m[static_cast<std::size_t>(id)]; };
  const auto [earlier, later] = way(first_seen_m_, a) <= way(first_seen_m_, b) ? std::pair(a, b) : std::pair(b, a);
  const double walked = way(first_seen_m_, later) - way(last_seen_m_, earlier);
  if (walked <= 0.0) return no_match;  // no drift between them: find_duplicates() has them where they are one
  const double sigma_m = config_.drift_m + config_.room_drift * config_.drift_per_m * walked;
  const double sigma_rad = config_.drift_rad + config_.room_drift * config_.drift_rad_per_m * walked;
  const double offset = offset_between(*p, *q);
  if (std::abs(offset) > config_.room_offset_m) return no_match;
  return (offset * offset / (sigma_m * sigma_m) +
          (p->plane_F.n - q->plane_F.n).squaredNorm() / (sigma_rad * sigma_rad)) /
         config_.gate_chi2;
}

bool WallLayer::add_duplicates(Graph& graph, std::span<const PlaneNode> walls, std::span<const SameWall> pairs) const {
  bool added = false;
  for (const SameWall& pair : pairs) added |= add_duplicate(graph, *find(walls, pair.known), *find(walls, pair.found));
  return added;
}

}  // namespace plumbline::slam
