// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/bench/furnished.h"

#include <cmath>
#include <numbers>
#include <string>

#include "bim/geometry/pose.h"
#include "bim/random/stream.h"
#include "slam/io/packets/vlp16.h"

namespace plumbline::scenarios {

namespace {

namespace vlp16 = slam::vlp16;

constexpr double room_x_m = 4.0, room_y_m = 9.0, corridor_y_m = 2.0, height_m = 3.0;
constexpr double strip_y_m = 2.0 * room_y_m + corridor_y_m;
constexpr double thickness_m = 0.12;
constexpr double aisle_m = 0.5;  ///< kept free on both sides of the middle of a room
constexpr double sensor_z_m = 0.65;
constexpr int sides = 32;

/// Corner of room k nearest to the origin.
Eigen::Vector2d room_corner(const FurnishedConfig& config, int room) {
  const int strip = room / (2 * config.columns);
  const int column = room / 2 % config.columns;
  return {column * room_x_m, strip * strip_y_m + (room % 2 == 0 ? 0.0 : room_y_m + corridor_y_m)};
}

class Storey {
 public:
  explicit Storey(std::uint64_t seed) : stream_(seed, "bim.generate") {}

  /// A prism over a counter-clockwise convex outline.
  void add_prism(const std::vector<Eigen::Vector2d>& outline, double z0, double z1) {
    const int n = static_cast<int>(outline.size());
    const int base = static_cast<int>(mesh_.vertices.size());
    for (const double z : {z0, z1})
      for (const Eigen::Vector2d& p : outline) mesh_.vertices.emplace_back(p.x(), p.y(), z);
    bim::MeshElement element;
    element.id = "e" + std::to_string(mesh_.elements.size());
    element.first_triangle = static_cast<int>(mesh_.triangles.size());
    for (int i = 0; i < n; ++i) {
      const int j = (i + 1) % n;
      add_triangle(base, i, j, n + j);
      add_triangle(base, i, n + j, n + i);
    }
    for (int i = 1; i + 1 < n; ++i) {
      add_triangle(base, 0, i + 1, i);
      add_triangle(base, n, n + i, n + i + 1);
    }
    element.triangle_count = static_cast<int>(mesh_.triangles.size()) - element.first_triangle;
    mesh_.elements.push_back(element);
  }

  void add_box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    add_prism({{low.x(), low.y()}, {high.x(), low.y()}, {high.x(), high.y()}, {low.x(), high.y()}}, low.z(), high.z());
  }

  /// A wall along x or y from a to b with a hole from h0 to h1 (heights z0 to z1) in the direction it runs.
  void add_wall_with_hole(bool along_x, double across, double a, double b, const Eigen::Vector4d& hole) {
    const auto part = [&](double s0, double s1, double z0, double z1) {
      if (along_x) {
        add_box({s0, across, z0}, {s1, across + thickness_m, z1});
      } else {
        add_box({across, s0, z0}, {across + thickness_m, s1, z1});
      }
    };
    part(a, hole[0], 0.0, height_m);
    part(hole[1], b, 0.0, height_m);
    part(hole[0], hole[1], hole[3], height_m);
    if (hole[2] > 0.0) part(hole[0], hole[1], 0.0, hole[2]);
  }

  void add_room(const Eigen::Vector2d& corner, bool door_at_far_side) {
    const double x0 = corner.x(), x1 = corner.x() + room_x_m;
    const double door_y = door_at_far_side ? corner.y() + room_y_m - thickness_m : corner.y();
    const double window_y = door_at_far_side ? corner.y() : corner.y() + room_y_m - thickness_m;
    add_wall_with_hole(true, door_y, x0, x1, {x0 + 1.5, x0 + 2.4, 0.0, 2.1});
    add_wall_with_hole(true, window_y, x0, x1, {x0 + 1.4, x0 + 2.6, 0.9, 2.1});
    add_box({x0 - 0.5 * thickness_m, corner.y(), 0.0}, {x0 + 0.5 * thickness_m, corner.y() + room_y_m, height_m});
  }

  void add_clutter(const Eigen::Vector2d& corner, int triangles) {
    const int end = static_cast<int>(mesh_.triangles.size()) + triangles;
    while (static_cast<int>(mesh_.triangles.size()) + 12 <= end) {
      const double side = uniform(0.0, 1.0) < 0.5 ? -1.0 : 1.0;
      const double x = corner.x() + 0.5 * room_x_m + side * uniform(aisle_m + 0.4, 0.5 * room_x_m - 0.35);
      const Eigen::Vector2d at(x, corner.y() + uniform(0.6, room_y_m - 0.6));
      const double z0 = uniform(0.0, 1.0) < 0.6 ? 0.0 : uniform(0.3, 1.8);
      const double z1 = z0 + uniform(0.1, 1.0);
      const bool round = uniform(0.0, 1.0) < 0.17;
      const double yaw = uniform(0.0, 2.0 * std::numbers::pi);
      add_prism(round ? circle(at, uniform(0.05, 0.25)) : rectangle(at, uniform(0.1, 0.35), uniform(0.05, 0.3), yaw),
                z0, z1);
    }
  }

  [[nodiscard]] bim::BuildingMesh take() { return std::move(mesh_); }

 private:
  double uniform(double low, double high) { return low + (high - low) * stream_.uniform(next_++); }

  static std::vector<Eigen::Vector2d> circle(const Eigen::Vector2d& at, double radius) {
    std::vector<Eigen::Vector2d> outline;
    for (int i = 0; i < sides; ++i) {
      const double a = 2.0 * std::numbers::pi * i / sides;
      outline.emplace_back(at + radius * Eigen::Vector2d(std::cos(a), std::sin(a)));
    }
    return outline;
  }
  static std::vector<Eigen::Vector2d> rectangle(const Eigen::Vector2d& at, double half_x, double half_y, double yaw) {
    const Eigen::Vector2d u(half_x * std::cos(yaw), half_x * std::sin(yaw));
    const Eigen::Vector2d v(-half_y * std::sin(yaw), half_y * std::cos(yaw));
    return {at - u - v, at + u - v, at + u + v, at - u + v};
  }
  void add_triangle(int base, int a, int b, int c) {
    mesh_.triangles.emplace_back(base + a, base + b, base + c);
    mesh_.element.push_back(static_cast<int>(mesh_.elements.size()));
  }

  Stream stream_;
  std::uint64_t next_ = 0;
  bim::BuildingMesh mesh_;
};

}  // namespace

bim::BuildingMesh furnished_storey(const FurnishedConfig& config, std::uint64_t seed) {
  Storey storey(seed);
  const double length = config.columns * room_x_m, width = config.strips * strip_y_m;
  storey.add_box({0.0, 0.0, -0.2}, {length, width, 0.0});
  storey.add_box({0.0, 0.0, height_m}, {length, width, height_m + 0.2});
  storey.add_box({length - 0.5 * thickness_m, 0.0, 0.0}, {length + 0.5 * thickness_m, width, height_m});
  for (int room = 0; room < config.rooms(); ++room) {
    const Eigen::Vector2d corner = room_corner(config, room);
    storey.add_room(corner, room % 2 == 0);
    storey.add_clutter(corner, config.clutter_triangles);
  }
  return storey.take();
}

std::vector<bim::Ray> turn_in_room(const FurnishedConfig& config, int room, std::uint64_t seed) {
  constexpr int rings = vlp16::rings, ring_step = 2, columns = 1800, column_step = 8;
  constexpr double turn_s = 0.1, speed_mps = 0.6, yaw_rate = 0.8;
  std::array<int, rings> laser_of_ring{};
  for (int laser = 0; laser < rings; ++laser)
    laser_of_ring[static_cast<std::size_t>(vlp16::ring_of_laser(laser))] = laser;
  const Stream stream(seed, "bim.generate");
  const auto tick = static_cast<std::uint64_t>(room);
  const Eigen::Vector2d middle = room_corner(config, room) + 0.5 * Eigen::Vector2d(room_x_m, room_y_m);
  const double yaw0 = 2.0 * std::numbers::pi * stream.uniform(tick, 1);
  const double y0 = middle.y() + 6.0 * (stream.uniform(tick, 2) - 0.5);

  std::vector<bim::Ray> rays;
  rays.reserve(std::size_t{rings} * columns);
  for (int column = 0; column < columns; column += column_step)
    for (int ring = 0; ring < rings; ring += ring_step)
      for (int lane = 0; lane < ring_step * column_step; ++lane) {
        const double part = static_cast<double>(column + lane % column_step) / columns;
        const int laser = laser_of_ring[static_cast<std::size_t>(ring + lane / column_step)];
        const Pose X_WL = Pose::from_xyz_yaw({middle.x(), y0 + speed_mps * turn_s * part, sensor_z_m},
                                             yaw0 + yaw_rate * turn_s * part);
        const Eigen::Matrix3d R_WL = X_WL.rotation();
        rays.push_back({X_WL.t + vlp16::vertical_offset_m(laser) * R_WL.col(2),
                        R_WL * vlp16::direction_L(laser, 2.0 * std::numbers::pi * part)});
      }
  return rays;
}

}  // namespace plumbline::scenarios
