// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <string>

#include "bim/model/building.h"
#include "bim/random/stream.h"

namespace plumbline::bim {

/// A building with every field drawn at random, whether or not it could stand: ids and names with quotes, line breaks
/// and letters of many scripts, numbers of many sizes, bodies that are mere triangles.
class RandomBuilding {
 public:
  explicit RandomBuilding(std::uint64_t seed) : random_(seed, "bim.generate") {}

  Building make() {
    Building b;
    b.name = text();
    for (int i = 0, n = 1 + whole(3); i < n; ++i)
      b.storeys.push_back({id("s", i), text(), number(), number(), i, StoreyKind(whole(3))});
    for (int i = 0, n = whole(4); i < n; ++i) b.materials.push_back({id("m", i), number(), number(), number()});
    const auto of = [&](std::size_t size) { return static_cast<int>(whole(static_cast<int>(size) + 1)) - 1; };
    const auto material = [&] {
      const int i = of(b.materials.size());
      return i >= 0 ? b.materials[static_cast<std::size_t>(i)].id : whole(2) == 0 ? std::string() : "other " + text();
    };
    const int storeys = static_cast<int>(b.storeys.size());
    for (int i = 0, n = 1 + whole(6); i < n; ++i)
      b.walls.push_back({id("w", i), text(), of(b.storeys.size()), point(), point(), number(), number(), number(),
                         number(), number(), material(), maybe_solid(), 0});
    for (int i = 0, n = whole(4); i < n; ++i)
      b.rooms.push_back({id("r", i), text(), whole(storeys), ring(), number(), number(), {}, {}, 0, {}});
    for (Room& room : b.rooms) {
      for (int w = 0; w < static_cast<int>(b.walls.size()); ++w)
        if (whole(2) == 0) room.walls.push_back(w);
      for (int i = 0, n = whole(3); i < n; ++i) room.virtual_edges.push_back({point(), point(), of(b.rooms.size())});
    }
    for (int i = 0, n = whole(6); i < n; ++i) {
      Opening o{id("o", i),
                whole(static_cast<int>(b.walls.size())),
                OpeningKind(whole(3)),
                number(),
                number(),
                number(),
                number(),
                Leaf(whole(3)),
                material(),
                maybe_solid(),
                {},
                text(),
                0,
                {of(b.rooms.size()), of(b.rooms.size())}};
      if (o.solid && whole(2) == 0) o.parts = {solid(), solid()};
      b.openings.push_back(o);
    }
    for (int i = 0, n = whole(3); i < n; ++i)
      b.slabs.push_back({id("f", i),
                         of(b.storeys.size()),
                         {ring(), {ring(), ring()}},
                         number(),
                         number(),
                         material(),
                         maybe_solid(),
                         0});
    for (int i = 0, n = whole(3); i < n; ++i)
      b.columns.push_back({id("c", i), of(b.storeys.size()), ring(), number(), number(), material(), maybe_solid(), 0});
    for (int i = 0, n = whole(3); i < n; ++i) {
      Stair stair{id("t", i),
                  text(),
                  of(b.storeys.size()),
                  of(b.storeys.size()),
                  {of(b.rooms.size()), of(b.rooms.size())},
                  {},
                  {},
                  material(),
                  {},
                  0};
      for (int k = 0, m = whole(3); k < m; ++k)
        stair.flights.push_back({point(), number(), number(), number(), whole(20), number(), number()});
      for (int k = 0, m = whole(2); k < m; ++k) stair.landings.push_back({ring(), number()});
      for (int k = 0, m = whole(4); k < m; ++k) stair.bodies.push_back(solid());
      b.stairs.push_back(stair);
    }
    for (const Opening& o : b.openings)
      if (whole(2) == 0)
        b.obstacles.push_back({o.id + "/leaf", o.kind == OpeningKind::window ? "window_pane" : "door_leaf",
                               of(b.storeys.size()), solid(), true, 0, material()});
    for (int i = 0, n = whole(4); i < n; ++i)
      b.obstacles.push_back({id("x", i), whole(2) == 0 ? "railing" : text(), of(b.storeys.size()), solid(),
                             whole(2) == 0, 0, material()});
    return b;
  }

 private:
  int whole(int below) { return static_cast<int>(random_.bits(++tick_) % static_cast<std::uint64_t>(below)); }
  double number() {
    ++tick_;
    return random_.gauss(tick_, 1) * std::pow(10.0, std::floor(8.0 * random_.uniform(tick_)) - 4.0);
  }
  Eigen::Vector2d point() {
    const double x = number();
    return {x, number()};
  }
  Polygon2 ring() {
    Polygon2 result;
    for (int i = 0, n = 3 + whole(4); i < n; ++i) result.push_back(point());
    return result;
  }
  Solid solid() {
    Solid result;
    for (int i = 0, n = 3 + whole(5); i < n; ++i) {
      const Eigen::Vector2d p = point();
      result.vertices.emplace_back(p.x(), p.y(), number());
    }
    const int n = static_cast<int>(result.vertices.size());
    for (int i = 0, m = 1 + whole(6); i < m; ++i) {
      const int a = whole(n), b = whole(n);
      result.triangles.emplace_back(a, b, whole(n));
    }
    return result;
  }
  std::optional<Solid> maybe_solid() { return whole(2) == 0 ? std::optional(solid()) : std::nullopt; }
  std::string text() {
    constexpr const char* pieces[] = {"a", "Tür", "'", "\"", "\\", "\n", "🏠", "ENDSEC;", "/*", "#1=", "\nDATA;", " "};
    std::string result;
    for (int i = 0, n = whole(5); i < n; ++i) result += pieces[whole(12)];
    return result;
  }
  std::string id(const char* kind, int i) { return kind + std::to_string(i) + text(); }

  Stream random_;
  std::uint64_t tick_ = 0;
};

}  // namespace plumbline::bim
