// SPDX-License-Identifier: Apache-2.0
#include "bim/furniture/shapes.h"

#include <algorithm>
#include <cmath>

#include "bim/errors.h"

namespace plumbline::bim {

namespace {

/// Joins boxes into one solid. Every box has its own vertices, so that each is closed by itself. No two share a whole
/// edge, so that the solid stays closed when vertices are joined by position.
class Boxes {
 public:
  /// A piece fills the size; parts are given in m from its low corner.
  explicit Boxes(const Eigen::Vector3d& size) : size_(size), low_(-0.5 * size.x(), -0.5 * size.y(), 0.0) {}

  void add(double x0, double x1, double y0, double y1, double z0, double z1) {
    if (!(x1 > x0 && y1 > y0 && z1 > z0)) throw InternalError("a part of a piece of furniture has no extent");
    const auto first = static_cast<int>(solid_.vertices.size());
    for (const double z : {z0, z1})
      for (const auto& [x, y] : {std::pair{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}})
        solid_.vertices.push_back(low_ + Eigen::Vector3d(x, y, z));
    const auto face = [&](int a, int b, int c, int d) {
      solid_.triangles.emplace_back(first + a, first + b, first + c);
      solid_.triangles.emplace_back(first + a, first + c, first + d);
    };
    face(3, 2, 1, 0);  // below
    face(4, 5, 6, 7);  // above
    for (int i = 0; i < 4; ++i) face(i, (i + 1) % 4, (i + 1) % 4 + 4, i + 4);
  }

  /// Four legs of the given thickness below height `top`, set back from the edges.
  void add_legs(double thickness, double back, double top) {
    for (const double x : {back, size_.x() - back - thickness})
      for (const double y : {back, size_.y() - back - thickness}) add(x, x + thickness, y, y + thickness, 0.0, top);
  }

  [[nodiscard]] double x() const { return size_.x(); }
  [[nodiscard]] double y() const { return size_.y(); }
  [[nodiscard]] double z() const { return size_.z(); }
  [[nodiscard]] double narrow() const { return std::min(size_.x(), size_.y()); }
  [[nodiscard]] Solid take() { return std::move(solid_); }

 private:
  Eigen::Vector3d size_, low_;
  Solid solid_;
};

// Parts are of usual thickness, or a share of the size where a piece is small.

void add_table(Boxes& b) {
  const double top = std::min(0.04, 0.2 * b.z()), leg = std::min(0.06, 0.15 * b.narrow());
  b.add(0, b.x(), 0, b.y(), b.z() - top, b.z());
  b.add_legs(leg, 0.3 * leg, b.z() - top);
}

void add_desk(Boxes& b) {
  const double top = std::min(0.03, 0.2 * b.z()), side = std::min(0.04, 0.1 * b.x());
  const double under = b.z() - top, back = std::min(0.02, 0.1 * b.y()), in = 0.05 * b.y();
  b.add(0, b.x(), 0, b.y(), under, b.z());
  b.add(0.5 * side, 1.5 * side, in, b.y() - in, 0, under);
  b.add(b.x() - 1.5 * side, b.x() - 0.5 * side, in, b.y() - in, 0, under);
  b.add(1.5 * side, b.x() - 1.5 * side, b.y() - 2 * in - back, b.y() - 2 * in, 0.4 * under, 0.95 * under);
}

void add_chair(Boxes& b) {
  const double seat = 0.5 * b.z(), thick = 0.08 * seat, leg = 0.09 * b.narrow(), back = 0.1 * b.y();
  b.add(0, b.x(), 0, b.y(), seat - thick, seat);
  b.add_legs(leg, 0.2 * leg, seat - thick);
  b.add(0.05 * b.x(), 0.95 * b.x(), b.y() - 1.1 * back, b.y() - 0.1 * back, seat, b.z());
}

void add_bed(Boxes& b) {
  const double lying = 0.6 * b.z(), frame = 0.4 * lying, leg = std::min(0.08, 0.15 * b.narrow());
  const double board = std::min(0.06, 0.05 * b.y());
  const double length = b.y() - board;
  b.add(0, b.x(), 0, length, frame, 0.8 * lying);
  b.add(0.03 * b.x(), 0.97 * b.x(), 0.03 * length, 0.99 * length, 0.8 * lying, lying);
  b.add_legs(leg, 0.5 * leg + board, frame);
  b.add(0.01 * b.x(), 0.99 * b.x(), length, b.y(), 0.5 * frame, b.z());
}

void add_sofa(Boxes& b) {
  const double seat = 0.5 * b.z(), foot = 0.12 * b.z(), back = 0.28 * b.y(), arm = std::min(0.2, 0.15 * b.x());
  b.add(arm, b.x() - arm, 0.02 * b.y(), b.y() - back, foot, seat);
  b.add(arm, b.x() - arm, b.y() - back, b.y() - 0.01 * b.y(), 1.1 * foot, b.z());
  for (const double x : {0.0, b.x() - arm}) b.add(x, x + arm, 0, b.y(), foot, 0.7 * b.z());
  b.add_legs(0.5 * arm, 0.1 * arm, foot);
}

void add_shelf(Boxes& b) {
  const double thick = std::min({0.025, 0.05 * b.x(), 0.05 * b.z()}), back = std::min(0.01, 0.1 * b.y());
  for (const double x : {0.0, b.x() - thick}) b.add(x, x + thick, 0, b.y(), 0, b.z());
  b.add(thick, b.x() - thick, b.y() - back, 0.999 * b.y(), 0.01 * b.z(), 0.995 * b.z());
  const int gaps = std::clamp(static_cast<int>(std::lround(b.z() / 0.36)), 1, 12);
  for (int i = 0; i <= gaps; ++i) {
    const double z = 0.02 * b.z() + i * (0.97 * b.z() - thick) / gaps;
    b.add(thick, b.x() - thick, 0.02 * b.y(), b.y() - back, z, z + thick);
  }
}

void add_wardrobe(Boxes& b) {
  const double foot = std::min(0.1, 0.1 * b.z()), leg = std::min(0.06, 0.15 * b.narrow());
  b.add(0, b.x(), 0, b.y(), foot, b.z());
  b.add_legs(leg, 0.2 * leg, foot);
}

void add_kitchen(Boxes& b) {
  const double tall = std::min(0.6, 0.4 * b.x()), worktop = 0.43 * b.z(), top = 0.02 * b.z();
  const double plinth = 0.05 * b.z(), front = 0.08 * b.y();
  const double units = b.x() - tall;
  b.add(0.01 * units, units, 2 * front, 0.98 * b.y(), 0, plinth);
  b.add(0.005 * units, units, front, 0.99 * b.y(), plinth, worktop - top);
  b.add(0, units, 0, b.y(), worktop - top, worktop);
  b.add(units, b.x(), 0.5 * front, 0.995 * b.y(), 0, b.z());
}

void add_machine(Boxes& b) {
  const double bench = 0.55 * b.z();
  b.add(0.02 * b.x(), 0.98 * b.x(), 0.15 * b.y(), 0.98 * b.y(), 0, 0.1 * b.z());
  b.add(0, b.x(), 0.1 * b.y(), b.y(), 0.1 * b.z(), bench);
  b.add(0.05 * b.x(), 0.6 * b.x(), 0.3 * b.y(), 0.95 * b.y(), bench, b.z());
  b.add(0.8 * b.x(), 0.85 * b.x(), 0.04 * b.y(), 0.09 * b.y(), 0, 0.6 * b.z());
  b.add(0.72 * b.x(), 0.93 * b.x(), 0, 0.08 * b.y(), 0.6 * b.z(), 0.85 * b.z());
}

void add_pallet(Boxes& b) {
  const double height = std::min(0.144, 0.3 * b.z()), board = 0.18 * height;
  for (const double y : {0.0, 0.43, 0.86}) {
    b.add(0.01 * b.x(), 0.99 * b.x(), (y + 0.01) * b.y(), (y + 0.13) * b.y(), 0, board);
    for (const double x : {0.01, 0.44, 0.87})
      b.add((x + 0.005) * b.x(), (x + 0.115) * b.x(), (y + 0.015) * b.y(), (y + 0.125) * b.y(), board, height - board);
  }
  for (int i = 0; i < 5; ++i)
    b.add((0.2175 * i) * b.x(), (0.2175 * i + 0.13) * b.x(), 0, b.y(), height - board, height);
  b.add(0.02 * b.x(), 0.98 * b.x(), 0.02 * b.y(), 0.98 * b.y(), height, b.z());
}

/// Sits on a block; front towards -y.
void add_person(Boxes& b) {
  const double seat = 0.34 * b.z(), lap = 0.45 * b.z(), shoulders = 0.8 * b.z();
  b.add(0.1 * b.x(), 0.9 * b.x(), 0.35 * b.y(), 0.98 * b.y(), 0, seat);
  for (const double x : {0.14, 0.58}) b.add(x * b.x(), (x + 0.28) * b.x(), 0, 0.25 * b.y(), 0, seat);
  b.add(0.1 * b.x() + 0.02 * b.x(), 0.88 * b.x(), 0.01 * b.y(), 0.97 * b.y(), seat, lap);
  b.add(0, b.x(), 0.55 * b.y(), b.y(), lap, shoulders);
  b.add(0.32 * b.x(), 0.68 * b.x(), 0.5 * b.y(), 0.95 * b.y(), shoulders, b.z());
}

void build(FurnitureShape shape, Boxes& boxes) {
  switch (shape) {
    case FurnitureShape::table:
      return add_table(boxes);
    case FurnitureShape::desk:
      return add_desk(boxes);
    case FurnitureShape::chair:
      return add_chair(boxes);
    case FurnitureShape::bed:
      return add_bed(boxes);
    case FurnitureShape::sofa:
      return add_sofa(boxes);
    case FurnitureShape::shelf:
      return add_shelf(boxes);
    case FurnitureShape::wardrobe:
      return add_wardrobe(boxes);
    case FurnitureShape::kitchen:
      return add_kitchen(boxes);
    case FurnitureShape::machine:
      return add_machine(boxes);
    case FurnitureShape::pallet:
      return add_pallet(boxes);
    case FurnitureShape::person:
      return add_person(boxes);
  }
  throw InternalError("unknown shape of furniture");
}

}  // namespace

Solid furniture_solid(FurnitureShape shape, const Eigen::Vector3d& size) {
  constexpr double size_min_m = 0.01;
  if (!(size.minCoeff() >= size_min_m)) throw InternalError("a piece of furniture is smaller than 1 cm");
  Boxes boxes(size);
  build(shape, boxes);
  return boxes.take();
}

Solid furniture_solid(FurnitureShape shape, const Eigen::Vector3d& size, const Eigen::Vector2d& at, double yaw,
                      double floor_z_m) {
  Solid solid = furniture_solid(shape, size);
  const double c = std::cos(yaw), s = std::sin(yaw);
  for (Eigen::Vector3d& p : solid.vertices)
    p = {at.x() + c * p.x() - s * p.y(), at.y() + s * p.x() + c * p.y(), floor_z_m + p.z()};
  return solid;
}

}  // namespace plumbline::bim
