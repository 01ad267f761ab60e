// SPDX-License-Identifier: Apache-2.0
#include "bim/generators/feature.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumbline::bim {

namespace {

constexpr double beside_opening_m = 0.15;  ///< wall between an opening and a corner's inner face
constexpr double niche_width_m = 1.0;      ///< between the reference lines of its reveals
constexpr double before_m = 0.03;  ///< distance of the points in front of a surface that are tested for visibility
constexpr double way_m = 1.0;      ///< kept free between a feature on the floor and the middle of a door

Eigen::Vector2d left_of(const Eigen::Vector2d& e) { return {-e.y(), e.x()}; }

/// Every opening has a wall of its own stretch around it.
bool openings_fit(const FloorTemplate& floor, const GeneratorOptions& options) {
  const std::vector<TemplateWall> walls = walls_of(floor);
  std::vector<int> hosts;
  for (const TemplateOpening& opening : floor.openings) {
    const int host = wall_at(walls, opening.at);
    if (host < 0) return false;
    const TemplateWall& wall = walls[static_cast<std::size_t>(host)];
    const double needed = 0.5 * opening.width_m + beside_opening_m + 0.5 * options.facade_m;
    if (std::min((opening.at - wall.a).norm(), (opening.at - wall.b).norm()) < needed) return false;
    for (std::size_t i = 0; i < hosts.size(); ++i) {
      const TemplateOpening& other = floor.openings[i];
      const double apart = (other.at - opening.at).norm() - 0.5 * (other.width_m + opening.width_m);
      if (hosts[i] == host && apart < beside_opening_m) return false;
    }
    hosts.push_back(host);
  }
  return true;
}

/// Makes one kind of feature of a room.
class Placer {
 public:
  Placer(const FloorTemplate& floor, const GeneratorOptions& options, const std::string& room)
      : floor_(floor), options_(options), walls_(walls_of(floor)), room_(floor.find_room(room)) {}

  std::vector<FeaturedTemplate> place() {
    switch (options_.feature) {
      case FeatureKind::none:
        break;
      case FeatureKind::door_shift:
        shift_doors();
        break;
      case FeatureKind::wall_shift:
        shift_walls();
        break;
      case FeatureKind::niche:
      case FeatureKind::window:
        open_facade();
        break;
      case FeatureKind::column:
      case FeatureKind::clutter:
        fill_corners();
        break;
    }
    return std::move(placed_);
  }

 private:
  [[nodiscard]] const Polygon2& outline() const { return floor_.rooms[static_cast<std::size_t>(room_)].outline; }
  [[nodiscard]] bool of_room(const TemplateWall& wall) const {
    return wall.rooms[0] == room_ || wall.rooms[1] == room_;
  }
  [[nodiscard]] bool is_seen(const TemplateWall& wall) const { return wall.rooms[1] < 0 || !options_.glass; }

  /// Keeps the template when every opening fits. The element of a wall is found by its position.
  void keep(FeaturedTemplate featured) {
    if (!openings_fit(featured.floor, options_)) return;
    if (featured.element.empty()) {
      GeneratorOptions plain = options_;
      PlanFile plan;
      add_storey_entries(featured.floor, plain, "", "", plan);
      const int wall = wall_at(walls_of(featured.floor), featured.at);
      if (wall < 0) return;
      featured.element = plan.walls[static_cast<std::size_t>(wall)].id;
    }
    constexpr double steps = 1e6;  // as all written coordinates
    featured.at = (featured.at * steps).array().round() / steps;
    placed_.push_back(std::move(featured));
  }

  void shift_doors() {
    for (std::size_t i = 0; i < floor_.openings.size(); ++i) {
      const TemplateOpening& door = floor_.openings[i];
      const int host = wall_at(walls_, door.at);
      if (door.kind != OpeningKind::door || host < 0) continue;
      const TemplateWall& wall = walls_[static_cast<std::size_t>(host)];
      if (!of_room(wall) || !is_seen(wall)) continue;
      const Eigen::Vector2d e = (wall.b - wall.a).normalized();
      for (const double sign : {1.0, -1.0}) {
        FeaturedTemplate featured{floor_, door.id, door.at + sign * options_.epsilon_m * e, {}};
        featured.floor.openings[i].at = featured.at;
        for (const double end : {-0.5, 0.5})
          featured.seen_at.emplace_back(featured.at + end * (door.width_m - 2.0 * before_m) * e);
        keep(std::move(featured));
      }
    }
  }

  /// Moves corners p and q of every room that has the whole edge p-q, and the openings between them.
  void shift_walls() {
    for (std::size_t k = 0; k < outline().size(); ++k) {
      const Eigen::Vector2d p = outline()[k], q = outline()[(k + 1) % outline().size()];
      const int host = wall_at(walls_, 0.5 * (p + q));
      if (host < 0 || !is_seen(walls_[static_cast<std::size_t>(host)]) || !moves_freely(p, q)) continue;
      const Eigen::Vector2d e = (q - p).normalized(), n = left_of(e);
      for (const double sign : {-1.0, 1.0}) {
        const Eigen::Vector2d by = sign * options_.epsilon_m * n;
        FeaturedTemplate featured{floor_, "", 0.5 * (p + q) + by, {}};
        for (TemplateRoom& room : featured.floor.rooms)
          for (Eigen::Vector2d& corner : room.outline)
            if ((corner - p).norm() < same_m || (corner - q).norm() < same_m) corner += by;
        for (TemplateOpening& opening : featured.floor.openings)
          if (segment_distance(p, q, opening.at) < same_m) opening.at += by;
        for (const double along : {-0.35, 0.0, 0.35})
          for (const double side : {-1.0, 1.0})
            featured.seen_at.emplace_back(featured.at + along * (q - p) +
                                          side * (0.5 * options_.facade_m + before_m) * n);
        keep(std::move(featured));
      }
    }
  }

  /// Both ends stand at a right angle to the edge in every room that has them as a corner, and no other room does.
  [[nodiscard]] bool moves_freely(const Eigen::Vector2d& p, const Eigen::Vector2d& q) const {
    for (const TemplateRoom& room : floor_.rooms) {
      const std::size_t n = room.outline.size();
      int ends = 0;
      for (std::size_t k = 0; k < n; ++k) {
        const Eigen::Vector2d &a = room.outline[k], &before = room.outline[(k + n - 1) % n],
                              &after = room.outline[(k + 1) % n];
        const bool is_p = (a - p).norm() < same_m, is_q = (a - q).norm() < same_m;
        if (!is_p && !is_q) continue;
        ++ends;
        const Eigen::Vector2d e = (q - p).normalized();
        const bool square = std::abs(std::abs((a - before).normalized().dot(e)) +
                                     std::abs((after - a).normalized().dot(e)) - 1.0) < same_m;
        if (!square) return false;
      }
      if (ends == 1) return false;
    }
    return true;
  }

  /// A niche or window at every half metre of the room's outer walls.
  void open_facade() {
    constexpr double step_m = 0.5;
    const bool niche = options_.feature == FeatureKind::niche;
    const double width = niche ? niche_width_m : options_.epsilon_m;
    for (const TemplateWall& wall : walls_) {
      if (wall.rooms[0] != room_ || wall.rooms[1] >= 0) continue;
      const Eigen::Vector2d e = (wall.b - wall.a).normalized(), out = -left_of(e);
      const double length = (wall.b - wall.a).norm();
      const double end = 0.5 * width + options_.facade_m + beside_opening_m;
      for (double s = end; s <= length - end; s += step_m) {
        const Eigen::Vector2d at = wall.a + s * e;
        FeaturedTemplate featured{floor_, "", at, {at - (0.5 * options_.partition_m + before_m) * out}};
        if (niche) {
          featured.at += options_.epsilon_m * out;
          if (!add_niche(featured.floor, at, e, out)) continue;
        } else {
          featured.element = "feature_window";
          featured.floor.openings.push_back({"feature_window", OpeningKind::window, at, width, 1.5, 0.3});
        }
        keep(std::move(featured));
      }
    }
  }

  /// The room's outline goes out by epsilon between p - and p +; openings keep their distance from its reveals.
  bool add_niche(FloorTemplate& floor, const Eigen::Vector2d& at, const Eigen::Vector2d& e,
                 const Eigen::Vector2d& out) const {
    Polygon2& polygon = floor.rooms[static_cast<std::size_t>(room_)].outline;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      if (segment_distance(polygon[k], polygon[(k + 1) % polygon.size()], at) > same_m) continue;
      const Eigen::Vector2d a = at - 0.5 * niche_width_m * e, b = at + 0.5 * niche_width_m * e;
      const Eigen::Vector2d by = options_.epsilon_m * out;
      const Polygon2 corners = {a, a + by, b + by, b};
      polygon.insert(polygon.begin() + static_cast<std::ptrdiff_t>(k) + 1, corners.begin(), corners.end());
      return true;
    }
    return false;
  }

  void fill_corners() {
    const bool column = options_.feature == FeatureKind::column;
    const Polygon2& polygon = outline();
    const double half = 0.5 * options_.epsilon_m, off = half + 0.5 * options_.partition_m + 0.1;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const std::size_t n = polygon.size();
      const Eigen::Vector2d in = (polygon[k] - polygon[(k + n - 1) % n]).normalized();
      const Eigen::Vector2d onward = (polygon[(k + 1) % n] - polygon[k]).normalized();
      if (std::abs(in.dot(onward)) > same_m || left_of(in).dot(onward) < 0.0) continue;
      const Eigen::Vector2d at = polygon[k] + off * (onward - in);
      const bool in_the_way = std::any_of(floor_.openings.begin(), floor_.openings.end(), [&](const auto& opening) {
        return opening.kind == OpeningKind::door && (opening.at - at).norm() < way_m + half;
      });
      if (in_the_way) continue;
      FeaturedTemplate featured{floor_, column ? "feature_column" : "feature_box", at, {}};
      const double yaw_deg = std::remainder(std::atan2(onward.y(), onward.x()) * 180.0 / std::numbers::pi, 90.0);
      const double turned = std::abs(yaw_deg) < same_m ? 0.0 : yaw_deg;
      if (column)
        featured.floor.add_column(featured.element, at, options_.epsilon_m, turned);
      else
        featured.floor.add_box(featured.element, at, options_.epsilon_m, turned);
      for (const Eigen::Vector2d& way : {Eigen::Vector2d(onward - in), Eigen::Vector2d(onward), Eigen::Vector2d(-in)})
        featured.seen_at.emplace_back(at + (half + before_m) * way);
      keep(std::move(featured));
    }
  }

  const FloorTemplate& floor_;
  const GeneratorOptions& options_;
  std::vector<TemplateWall> walls_;
  int room_ = -1;
  std::vector<FeaturedTemplate> placed_;
};

}  // namespace

std::vector<FeaturedTemplate> place_feature(const FloorTemplate& floor, const GeneratorOptions& options,
                                            const std::string& room) {
  return Placer(floor, options, room).place();
}

}  // namespace plumbline::bim
