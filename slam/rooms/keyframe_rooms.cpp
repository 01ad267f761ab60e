// SPDX-License-Identifier: Apache-2.0
#include "slam/rooms/keyframe_rooms.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "slam/planes/forms.h"

namespace plumbline::slam {

namespace {

using Eigen::Vector2d;

/// A wall in plan: m.p + e = 0, m unit and towards the robot.
struct Face {
  int id = -1;
  Vector2d m = Vector2d::UnitX();
  double e = 0.0;
  Vector2d p0 = Vector2d::Zero(), p1 = Vector2d::Zero();

  [[nodiscard]] double distance(const Vector2d& p) const { return m.dot(p) + e; }
  [[nodiscard]] double length() const { return (p1 - p0).norm(); }
  [[nodiscard]] Vector2d middle() const { return 0.5 * (p0 + p1); }
};

struct Opposed {
  Face a, b;
  [[nodiscard]] double length() const { return a.length() + b.length(); }
};

std::vector<Face> faces_of(std::span<const PlaneNode> seen_M, PlaneAxis axis) {
  std::vector<Face> faces;
  for (const PlaneNode& node : seen_M) {
    if (axis_of(node.plane_F.n) != axis) continue;
    const Vector2d m = node.plane_F.n.head<2>().normalized();
    faces.push_back({node.id, m, -m.dot(0.5 * (node.p0 + node.p1)), node.p0, node.p1});
  }
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.id < b.id; });
  return faces;
}

std::optional<Opposed> longest_pair(const std::vector<Face>& faces, const Vector2d& robot, const RoomConfig& config) {
  const double opposed = -std::cos(config.opposed_deg * std::numbers::pi / 180.0);
  std::optional<Opposed> best;
  for (std::size_t i = 0; i < faces.size(); ++i)
    for (std::size_t j = i + 1; j < faces.size(); ++j) {
      const Face &a = faces[i], &b = faces[j];
      if (a.id == b.id || a.m.dot(b.m) > opposed) continue;
      if (a.distance(robot) <= 0.0 || b.distance(robot) <= 0.0) continue;
      if (a.distance(robot) + b.distance(robot) < config.min_width_m) continue;
      if (!best || a.length() + b.length() > best->length()) best = Opposed{a, b};
    }
  return best;
}

bool between(const Opposed& pair, const Vector2d& p) { return pair.a.distance(p) > 0.0 && pair.b.distance(p) > 0.0; }

Vector2d intersection(const Vector2d& m, double e, const Vector2d& n, double f) {
  Eigen::Matrix2d A;
  A << m.transpose(), n.transpose();
  return -(A.inverse() * Vector2d(e, f));
}

Polygon2 counter_clockwise(Polygon2 polygon) {
  if (signed_area(polygon) < 0.0) std::reverse(polygon.begin(), polygon.end());
  return polygon;
}

RoomCandidate four_walls(const Opposed& x, const Opposed& y) {
  RoomCandidate room;
  room.kind = RoomKind::four_wall;
  room.planes = {x.a.id, x.b.id, y.a.id, y.b.id};
  const auto corner = [](const Face& f, const Face& g) { return intersection(f.m, f.e, g.m, g.e); };
  room.polygon_M = counter_clockwise({corner(x.a, y.a), corner(x.b, y.a), corner(x.b, y.b), corner(x.a, y.b)});
  room.center_M = 0.25 * (room.polygon_M[0] + room.polygon_M[1] + room.polygon_M[2] + room.polygon_M[3]);
  room.cluster_M = room.center_M;
  return room;
}

std::optional<RoomCandidate> two_walls(const Opposed& pair, const RoomConfig& config) {
  const Vector2d n = (pair.a.m - pair.b.m).normalized();
  const Vector2d t(-n.y(), n.x());
  const auto low = [&](const Face& f) { return std::min(t.dot(f.p0), t.dot(f.p1)); };
  const auto high = [&](const Face& f) { return std::max(t.dot(f.p0), t.dot(f.p1)); };
  const double from = std::max(low(pair.a), low(pair.b)), to = std::min(high(pair.a), high(pair.b));
  if (to - from < config.min_two_wall_m) return {};
  RoomCandidate room;
  room.kind = RoomKind::two_wall;
  room.planes = {pair.a.id, pair.b.id};
  const auto corner = [&](const Face& f, double s) { return intersection(f.m, f.e, t, -s); };
  room.polygon_M =
      counter_clockwise({corner(pair.a, from), corner(pair.b, from), corner(pair.b, to), corner(pair.a, to)});
  room.center_M = 0.25 * (room.polygon_M[0] + room.polygon_M[1] + room.polygon_M[2] + room.polygon_M[3]);
  room.cluster_M = room.center_M;
  return room;
}

}  // namespace

std::vector<RoomCandidate> keyframe_rooms(std::span<const PlaneNode> seen_M, const Vector2d& robot_M,
                                          const RoomConfig& config) {
  const std::optional<Opposed> x = longest_pair(faces_of(seen_M, PlaneAxis::x), robot_M, config);
  const std::optional<Opposed> y = longest_pair(faces_of(seen_M, PlaneAxis::y), robot_M, config);
  if (x && y && between(*y, x->a.middle()) && between(*y, x->b.middle()) && between(*x, y->a.middle()) &&
      between(*x, y->b.middle()))
    return {four_walls(*x, *y)};
  const std::optional<Opposed>& longer = x && (!y || x->length() >= y->length()) ? x : y;
  if (!longer) return {};
  const std::optional<RoomCandidate> room = two_walls(*longer, config);
  return room ? std::vector<RoomCandidate>{*room} : std::vector<RoomCandidate>{};
}

}  // namespace plumbline::slam
