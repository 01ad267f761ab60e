// SPDX-License-Identifier: Apache-2.0
#include "slam/rooms/keyframe_rooms.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "slam/planes/forms.h"
#include "slam/rooms/cluster_walls.h"

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

/// Ends of a wall sorted along it.
std::array<double, 2> ends(const Face& face, const Vector2d& along) {
  const double a = along.dot(face.p0), b = along.dot(face.p1);
  return {std::min(a, b), std::max(a, b)};
}

/// Lengths and widths that a pair may have.
struct Window {
  double least_length_m, most_length_m, least_width_m, most_width_m, ends_m;
};

/// Of the pairs in the window the one whose ends lie nearest to each other along the walls (ties: lower ids).
std::optional<Opposed> nearest_ends(const std::vector<Face>& faces, const Vector2d& robot, const Window& window,
                                    double length_difference_m) {
  std::optional<Opposed> best;
  double best_m = window.ends_m;
  for (std::size_t i = 0; i < faces.size(); ++i)
    for (std::size_t j = i + 1; j < faces.size(); ++j) {
      const Face &a = faces[i], &b = faces[j];
      if (a.id == b.id || a.m.dot(b.m) > 0.0 || a.distance(robot) <= 0.0 || b.distance(robot) <= 0.0) continue;
      const double width_m = a.distance(robot) + b.distance(robot);
      if (width_m < window.least_width_m || width_m > window.most_width_m) continue;
      if (std::min(a.length(), b.length()) < window.least_length_m ||
          std::max(a.length(), b.length()) > window.most_length_m ||
          std::abs(a.length() - b.length()) >= length_difference_m)
        continue;
      const Vector2d along(-a.m.y(), a.m.x());
      const std::array<double, 2> of_a = ends(a, along), of_b = ends(b, along);
      const double off_m = 0.5 * (std::abs(of_a[0] - of_b[0]) + std::abs(of_a[1] - of_b[1]));
      if (off_m >= best_m) continue;
      best_m = off_m;
      best = Opposed{a, b};
    }
  return best;
}

double width(const Opposed& pair, const Vector2d& robot) { return pair.a.distance(robot) + pair.b.distance(robot); }

bool between(const Opposed& pair, const Vector2d& p) { return pair.a.distance(p) > 0.0 && pair.b.distance(p) > 0.0; }

Vector2d intersection(const Vector2d& m, double e, const Vector2d& n, double f) {
  Eigen::Matrix2d A;
  A << m.transpose(), n.transpose();
  return -(A.inverse() * Vector2d(e, f));
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

std::vector<RoomCandidate> rooms_by_end_points(std::span<const PlaneNode> seen_M, const Vector2d& robot_M,
                                               const RoomConfig& config, const KeyframeRoomConfig& rules) {
  constexpr double any_m = std::numeric_limits<double>::infinity();
  const std::vector<Face> x_faces = faces_of(seen_M, PlaneAxis::x), y_faces = faces_of(seen_M, PlaneAxis::y);
  const Window room{rules.room_least_length_m, rules.room_most_length_m, rules.room_least_width_m,
                    rules.room_most_width_m, rules.room_ends_m};
  const Window corridor{rules.corridor_length_m, any_m, rules.corridor_least_width_m, rules.corridor_most_width_m,
                        rules.corridor_ends_m};
  std::vector<RoomCandidate> found;
  const auto x = nearest_ends(x_faces, robot_M, room, rules.length_difference_m);
  const auto y = nearest_ends(y_faces, robot_M, room, rules.length_difference_m);
  if (x && y && std::abs(width(*x, robot_M) - width(*y, robot_M)) < rules.width_difference_m)
    found.push_back(four_walls(*x, *y));
  for (const std::vector<Face>* faces : {&x_faces, &y_faces})
    if (const auto pair = nearest_ends(*faces, robot_M, corridor, rules.length_difference_m))
      if (const std::optional<RoomCandidate> one = two_walls(*pair, config)) found.push_back(*one);
  return found;
}

}  // namespace

std::vector<RoomCandidate> keyframe_rooms(std::span<const PlaneNode> seen_M, const Vector2d& robot_M,
                                          const RoomConfig& config, const KeyframeRoomConfig& rules) {
  if (rules.rule == KeyframeRoomRule::end_points) return rooms_by_end_points(seen_M, robot_M, config, rules);
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
