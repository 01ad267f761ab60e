// SPDX-License-Identifier: Apache-2.0
#include "bim/model/floors.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "bim/geometry/polygon_boolean.h"
#include "bim/model/body_section.h"
#include "bim/model/boxes.h"
#include "bim/model/hull.h"
#include "bim/model/upward_faces.h"
#include "bim/model/wall_face.h"

namespace plumbline::bim {
namespace {

/// Everything in the box where a + b.p > 0, as a polygon; empty where that is nowhere.
Polygon2 half_plane(const Eigen::AlignedBox2d& box, double a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d low = box.min(), high = box.max();
  const std::array<Eigen::Vector2d, 4> corners = {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
  Polygon2 kept;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d &p = corners[i], &q = corners[(i + 1) % corners.size()];
    const double u = a + b.dot(p), v = a + b.dot(q);
    if (u > 0.0) kept.push_back(p);
    if ((u > 0.0) != (v > 0.0)) kept.push_back(p + (q - p) * (u / (u - v)));
  }
  return kept.size() < 3 ? Polygon2{} : kept;
}

Region2 region_of(const PolygonWithHoles2& polygon) {
  return subtract(unite(std::vector<Polygon2>{polygon.outer}), polygon.holes);
}

Region2 less(const Region2& region, const Region2& cut) {
  std::vector<Polygon2> outers;
  Region2 rest = region;
  for (const PolygonWithHoles2& piece : cut) {
    // A hole of what is cut away keeps what is in it.
    Region2 kept;
    if (!piece.holes.empty()) {
      std::vector<Polygon2> holes;
      for (Polygon2 hole : piece.holes) {
        std::reverse(hole.begin(), hole.end());
        holes.push_back(std::move(hole));
      }
      kept = intersect(rest, unite(holes));
    }
    rest = subtract(rest, std::vector<Polygon2>{piece.outer});
    rest.insert(rest.end(), kept.begin(), kept.end());
  }
  return rest;
}

/// Whether a side of one of two convex polygons, counter-clockwise, parts them.
bool part(const Polygon2& one, const Polygon2& other) {
  constexpr double depth_m = 1e-6;  // less is no area on the grid of the booleans
  for (std::size_t i = 0; i < one.size(); ++i) {
    const Eigen::Vector2d side = one[(i + 1) % one.size()] - one[i];
    const Eigen::Vector2d out = Eigen::Vector2d(side.y(), -side.x()).normalized();
    if (std::all_of(other.begin(), other.end(), [&](const auto& p) { return out.dot(p - one[i]) >= -depth_m; }))
      return true;
  }
  return false;
}

constexpr double same_m = 1e-3;  ///< heights this close are one

class Floors {
 public:
  Floors(const Building& building, const FloorConfig& config) : building_(building), config_(config) {}

  std::vector<FloorPiece> find() {
    for (std::size_t i = 0; i < building_.slabs.size(); ++i) {
      const Slab& slab = building_.slabs[i];
      const auto element = static_cast<int>(i);
      if (slab.body)
        add_body(FloorSource::slab, element, *slab.body);
      else
        add(FloorSource::slab, element, slab.polygon, {slab.z1_m, Eigen::Vector2d::Zero(), slab.z1_m, {}});
    }
    for (std::size_t i = 0; i < building_.obstacles.size(); ++i)
      if (carries(building_.obstacles[i]))
        add_body(FloorSource::obstacle, static_cast<int>(i), building_.obstacles[i].body);
    cut_covered();
    add_rooms();
    add_within_walls();
    const auto order = [](const FloorPiece& a, const FloorPiece& b) {
      const auto key = [](const FloorPiece& f) {
        const Eigen::Vector2d& p = f.polygon.outer.front();
        return std::make_tuple(f.storey, f.z_at(p), p.x(), p.y(), f.source, f.element);
      };
      return key(a) < key(b);
    };
    std::stable_sort(pieces_.begin(), pieces_.end(), order);
    return std::move(pieces_);
  }

 private:
  [[nodiscard]] bool carries(const Obstacle& obstacle) const {
    return obstacle.kind == "ramp" || obstacle.kind == "footing" || is_floor_covering(building_, obstacle, config_);
  }

  void add(FloorSource source, int element, PolygonWithHoles2 polygon, const UpwardFace& face) {
    if (polygon.outer.size() < 3 || area({polygon}) < config_.least_m2) return;
    FloorPiece piece{source, element, -1, std::move(polygon), face.z0_m, face.slope};
    boxes_.add(piece.polygon.outer);
    hulls_.push_back(convex_hull(piece.polygon.outer));
    tops_m_.push_back(face.top_m);
    pieces_.push_back(std::move(piece));
  }

  void add_body(FloorSource source, int element, const Solid& body) {
    UpwardFaceConfig faces;
    faces.steepest = config_.steepest;
    faces.level = config_.level;
    faces.least_m2 = config_.least_m2;
    for (const UpwardFace& face : upward_faces(body, faces))
      for (PolygonWithHoles2& polygon : unite(face.triangles)) add(source, element, std::move(polygon), face);
  }

  /// Where b hides a: too little headroom under b.
  [[nodiscard]] Region2 hidden_by(const FloorPiece& a, const FloorPiece& b) const {
    const double dz = b.z0_m - a.z0_m;
    const Eigen::Vector2d dslope = b.slope - a.slope;
    if (dslope.isZero(0.0)) return dz > same_m && dz < config_.headroom_m ? region_of(b.polygon) : Region2{};
    const Eigen::AlignedBox2d box = box_of(b.polygon.outer);
    const Polygon2 above = half_plane(box, dz - same_m, dslope);
    const Polygon2 low = half_plane(box, config_.headroom_m - dz, -dslope);
    if (above.empty() || low.empty()) return {};
    return intersect(intersect(region_of(b.polygon), unite(std::vector<Polygon2>{above})),
                     unite(std::vector<Polygon2>{low}));
  }

  /// The slab that a may lie in: b is its top and higher than headroom above a, and it reaches down to a. -1: none.
  [[nodiscard]] int may_hold(const FloorPiece& a, const FloorPiece& b) const {
    if (b.source != FloorSource::slab || !a.slope.isZero(0.0)) return -1;
    const bool high = std::any_of(b.polygon.outer.begin(), b.polygon.outer.end(),
                                  [&](const auto& p) { return b.z_at(p) - a.z0_m >= config_.headroom_m; });
    const bool deep = building_.slabs[static_cast<std::size_t>(b.element)].z0_m <= a.z0_m + same_m;
    return high && deep ? b.element : -1;
  }

  /// The material of a slab right above a height, on the plan.
  const Region2& within(int element, double z_m) {
    const auto [at, fresh] = sections_.try_emplace({element, z_m});
    const Slab& slab = building_.slabs[static_cast<std::size_t>(element)];
    if (fresh) at->second = slab.body ? body_section(*slab.body, z_m + same_m) : region_of(slab.polygon);
    return at->second;
  }

  void cut_covered() {
    std::vector<FloorPiece> rest;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const FloorPiece& a = pieces_[i];
      Region2 region = {a.polygon};
      bool whole = true;
      std::set<int> holders;
      for (const int k : boxes_.near(a.polygon.outer, 0.0)) {
        const auto j = static_cast<std::size_t>(k);
        if (j == i || part(hulls_[i], hulls_[j]) || part(hulls_[j], hulls_[i])) continue;
        const FloorPiece& b = pieces_[j];
        if (const int holder = may_hold(a, b); holder >= 0) holders.insert(holder);
        // Of two faces at the same place the first one counts.
        const bool same = j < i && std::abs(b.z0_m - a.z0_m) <= same_m && (b.slope - a.slope).isZero(0.0);
        const Region2 hidden = same ? region_of(b.polygon) : hidden_by(a, b);
        if (hidden.empty()) continue;
        region = less(region, hidden);
        whole = false;
      }
      for (const int holder : holders) {
        const Region2& hidden = within(holder, tops_m_[i]);
        if (hidden.empty()) continue;
        region = less(region, hidden);
        whole = false;
      }
      for (PolygonWithHoles2& rest_of_a : region) {
        if (!whole && area({rest_of_a}) < config_.least_m2) continue;
        FloorPiece piece = a;
        piece.polygon = std::move(rest_of_a);
        piece.storey = storey_of(piece);
        rest.push_back(std::move(piece));
      }
    }
    pieces_ = std::move(rest);
  }

  [[nodiscard]] int storey_of(const FloorPiece& piece) const {
    const Eigen::Vector2d p = interior_point(piece.polygon.outer);
    const double z = piece.z_at(p);
    for (const Room& room : building_.rooms)
      if (std::abs(room.z0_m - z) <= config_.at_room_m && room.contains(p)) return room.storey;
    int found = -1;
    const double unbounded = config_.sunken_m;
    for (std::size_t i = 0; i < building_.storeys.size(); ++i) {
      const Storey& storey = building_.storeys[i];
      if (storey.kind != StoreyKind::habitable) continue;
      const double gap = found < 0
                             ? 2.0 * unbounded
                             : storey.elevation_m - building_.storeys[static_cast<std::size_t>(found)].elevation_m;
      if (storey.elevation_m <= z + std::min(unbounded, 0.5 * gap)) found = static_cast<int>(i);
    }
    return found;
  }

  /// Share of a room's area that stands on pieces at its lower end, by points of a grid. A well in a slab is none that
  /// the slab lacks.
  [[nodiscard]] double share_on_floor(const Room& room, const BoxIndex& boxes) const {
    constexpr int across = 9;
    const Eigen::AlignedBox2d box = box_of(room.polygon);
    const std::vector<int> near = boxes.near(room.polygon, 0.0);
    int inside = 0, carried = 0;
    for (int i = 0; i < across * across; ++i) {
      const Eigen::Array2d share((i % across + 0.5) / across, (i / across + 0.5) / across);
      const Eigen::Vector2d p = box.min() + (share * box.sizes().array()).matrix();
      if (!room.contains(p)) continue;
      ++inside;
      carried += std::any_of(near.begin(), near.end(), [&](int k) {
        const FloorPiece& piece = pieces_[static_cast<std::size_t>(k)];
        const double over = piece.z_at(p) - room.z0_m;
        return over >= -config_.sunken_m && over <= config_.at_room_m && contains(piece.polygon.outer, p);
      });
    }
    return inside > 0 ? static_cast<double>(carried) / inside : 1.0;
  }

  void add_rooms() {
    BoxIndex boxes;
    for (const FloorPiece& piece : pieces_) boxes.add(piece.polygon.outer);
    for (std::size_t i = 0; i < building_.rooms.size(); ++i) {
      const Room& room = building_.rooms[i];
      if (room.polygon.size() < 3 || share_on_floor(room, boxes) >= config_.covered_share) continue;
      pieces_.push_back(
          {FloorSource::room, static_cast<int>(i), room.storey, room.outline(), room.z0_m, Eigen::Vector2d::Zero()});
    }
  }

  void add_within_walls() {
    for (std::size_t i = 0; i < building_.storeys.size(); ++i) {
      const auto storey = static_cast<int>(i);
      if (building_.storeys[i].kind != StoreyKind::habitable) continue;
      if (std::any_of(pieces_.begin(), pieces_.end(), [&](const FloorPiece& p) { return p.storey == storey; }))
        continue;
      Polygon2 corners;
      for (const Wall& wall : building_.walls)
        if (wall.storey == storey)
          for (const Eigen::Vector2d& p : footprint(wall)) corners.push_back(p);
      Polygon2 hull = convex_hull(std::move(corners));
      if (hull.size() < 3) continue;
      pieces_.push_back({FloorSource::walls,
                         -1,
                         storey,
                         {std::move(hull), {}},
                         building_.storeys[i].elevation_m,
                         Eigen::Vector2d::Zero()});
    }
  }

  const Building& building_;
  FloorConfig config_;
  std::vector<FloorPiece> pieces_;
  BoxIndex boxes_;                                      ///< of pieces_ before cutting
  std::vector<Polygon2> hulls_;                         ///< of each of them
  std::vector<double> tops_m_;                          ///< highest corner of each
  std::map<std::pair<int, double>, Region2> sections_;  ///< by slab and height
};

}  // namespace

bool is_floor_covering(const Building& building, const Obstacle& obstacle, const FloorConfig& config) {
  if (obstacle.kind != "covering" || obstacle.body.triangles.empty()) return false;
  const Eigen::AlignedBox3d box = box_of(obstacle.body);
  if (box.sizes().z() > config.covering_m) return false;
  double level_m2 = 0.0;
  for (const Eigen::Vector3i& t : obstacle.body.triangles) {
    const auto p = [&](int k) { return obstacle.body.vertices[static_cast<std::size_t>(t[k])]; };
    level_m2 += std::max(0.0, 0.5 * (p(1) - p(0)).cross(p(2) - p(0)).z());
  }
  if (level_m2 < std::max(config.least_covering_m2, config.covering_share * box.sizes().x() * box.sizes().y()))
    return false;
  const auto meets = [&](double foot_m) {
    return foot_m >= box.min().z() - config.foot_m && foot_m <= box.max().z() + config.foot_m;
  };
  const Eigen::AlignedBox2d on_plan(box.min().head<2>(), box.max().head<2>());
  bool any_room = false;
  for (const Room& room : building.rooms) {
    if (room.storey != obstacle.storey) continue;
    any_room = true;
    if (meets(room.z0_m) && !room.polygon.empty() && on_plan.intersects(box_of(room.polygon))) return true;
  }
  return !any_room && obstacle.storey >= 0 &&
         meets(building.storeys[static_cast<std::size_t>(obstacle.storey)].elevation_m);
}

std::vector<FloorPiece> floor_pieces(const Building& building, const FloorConfig& config) {
  return Floors(building, config).find();
}

std::vector<Slab> assumed_slabs(const Building& building, double beyond_m) {
  constexpr double thickness_m = 0.02;  // any will do: it is seen from above
  std::vector<Slab> slabs;
  if (!building.stairs.empty()) return slabs;
  const std::vector<FloorPiece> pieces = floor_pieces(building);
  for (const FloorPiece& piece : pieces) {
    const bool built = std::any_of(pieces.begin(), pieces.end(), [&](const FloorPiece& other) {
      return other.storey == piece.storey &&
             (other.source == FloorSource::slab || other.source == FloorSource::obstacle);
    });
    if (built || piece.storey < 0) continue;
    Slab slab;
    slab.id = "assumed_floor/" + building.storeys[static_cast<std::size_t>(piece.storey)].id + "/" +
              std::to_string(slabs.size());
    slab.storey = piece.storey;
    slab.polygon = piece.polygon;
    if (piece.source == FloorSource::walls) {
      Polygon2 wider;
      for (const Eigen::Vector2d& p : piece.polygon.outer)
        for (const double dx : {-beyond_m, beyond_m})
          for (const double dy : {-beyond_m, beyond_m}) wider.emplace_back(p.x() + dx, p.y() + dy);
      slab.polygon = {convex_hull(std::move(wider)), {}};
    }
    slab.z1_m = piece.z0_m;
    slab.z0_m = piece.z0_m - thickness_m;
    slab.assumed = true;
    slabs.push_back(std::move(slab));
  }
  return slabs;
}

}  // namespace plumbline::bim
