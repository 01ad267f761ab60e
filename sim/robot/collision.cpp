// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/collision.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bim/model/through.h"
#include "bim/model/walked_floors.h"
#include "bim/model/wall_frame.h"
#include "bim/model/wall_section.h"
#include "sim/robot/solid_boxes.h"

namespace plumbline::sim {

namespace {

/// Heights a robot on the storeys can touch, in W, ascending and apart.
std::vector<HeightRange> touchable(const std::vector<bim::WalkedFloors>& storeys, const CollisionConfig& config) {
  std::vector<std::pair<double, double>> floors;  // the lowest and the highest of each storey
  for (const bim::WalkedFloors& of_storey : storeys) floors.emplace_back(of_storey.ground_m, of_storey.highest_m());
  std::sort(floors.begin(), floors.end());
  std::vector<HeightRange> out;
  for (const auto& [floor, highest] : floors) {
    const HeightRange range{floor + config.floor_gap_m, highest + config.reach_m};
    if (!out.empty() && overlap(range, out.back()))
      out.back().to = std::max(out.back().to, range.to);
    else
      out.push_back(range);
  }
  return out;
}

/// The wall under an open door, low enough to be walked over from the floor of the range.
bool is_sill(const HeightRange& z, const std::vector<const bim::Opening*>& openings, double s, const HeightRange& reach,
             const CollisionConfig& config) {
  // Of a door to a raised floor too, since the range reaches from the storey's floor to above the highest.
  if (z.to > std::max(reach.from - config.floor_gap_m + config.sill_max_m, reach.to - config.reach_m)) return false;
  return std::any_of(openings.begin(), openings.end(), [&](const bim::Opening* o) {
    return o->kind != bim::OpeningKind::window && o->z0_m == z.to && std::abs(s - o->s_m) < 0.5 * o->width_m;
  });
}

/// A closed leaf fills its opening, and a niche is closed by its wall.
bool passable(const bim::Opening& opening, const bim::Wall& wall) {
  return opening.leaf != bim::Leaf::closed && bim::goes_through(opening, wall);
}

/// Positions along the wall where its elevation can change, ascending, with extra cuts every length_max_m.
std::vector<double> wall_cuts(const bim::Wall& wall, const std::vector<const bim::Opening*>& openings,
                              double length_max_m) {
  const double length = wall.length();
  std::vector<double> cuts = {0.0, length};
  for (const bim::Opening* o : openings) {
    cuts.push_back(std::clamp(o->s_m - 0.5 * o->width_m, 0.0, length));
    cuts.push_back(std::clamp(o->s_m + 0.5 * o->width_m, 0.0, length));
  }
  std::sort(cuts.begin(), cuts.end());
  std::vector<double> all;
  for (const double cut : cuts) {
    const double last = all.empty() ? cut : all.back();
    const int parts = std::max(1, static_cast<int>(std::ceil((cut - last) / length_max_m)));
    for (int i = 1; i < parts; ++i) all.push_back(last + (cut - last) * i / parts);
    if (all.empty() || cut - last > 1e-6) all.push_back(cut);
  }
  return all;
}

/// Heights of the wall that are solid at s: the wall's own, minus every opening there.
std::vector<HeightRange> solid_heights(const bim::Wall& wall, const std::vector<const bim::Opening*>& openings,
                                       double s) {
  std::vector<HeightRange> solid = {{wall.z0_m, wall.z1_m}};
  for (const bim::Opening* o : openings) {
    if (std::abs(s - o->s_m) >= 0.5 * o->width_m) continue;
    std::vector<HeightRange> rest;
    for (const HeightRange& z : solid) {
      if (o->z0_m > z.from) rest.push_back({z.from, std::min(z.to, o->z0_m)});
      if (o->z1_m < z.to) rest.push_back({std::max(z.from, o->z1_m), z.to});
    }
    solid = std::move(rest);
  }
  return solid;
}

/// The parts of a cut beside a doorway of the wall.
std::vector<bim::WallCut> beside(const std::vector<bim::WallCut>& cuts, const Eigen::AlignedBox2d& doorway) {
  std::vector<bim::WallCut> rest;
  for (const bim::WallCut& cut : cuts) {
    double from = 0.0, to = 1.0;
    for (int axis = 0; axis < 2; ++axis) {
      const double a = cut.a[axis], d = cut.b[axis] - a, low = doorway.min()[axis], high = doorway.max()[axis];
      if (std::abs(d) < 1e-9) {
        if (a < low || a > high) to = -1.0;
        continue;
      }
      from = std::max(from, std::min((low - a) / d, (high - a) / d));
      to = std::min(to, std::max((low - a) / d, (high - a) / d));
    }
    if (from >= to) {
      rest.push_back(cut);
      continue;
    }
    const auto at = [&](double t) -> Eigen::Vector2d { return cut.a + t * (cut.b - cut.a); };
    if (from > 0.0) rest.push_back({cut.a, at(from)});
    if (to < 1.0) rest.push_back({at(to), cut.b});
  }
  return rest;
}

/// Thin boxes along the body's faces, in slices of the heights.
void add_wall_body(const bim::Wall& wall, const std::vector<const bim::Opening*>& openings, const HeightRange& reach,
                   const CollisionConfig& config, std::vector<CollisionBox>& boxes) {
  const bim::WallFrame frame(wall);
  const double yaw = std::atan2(wall.direction().y(), wall.direction().x());
  const HeightRange z{std::max(reach.from, wall.z0_m), std::min(reach.to, wall.z1_m)};
  // The lowest slice is of nothing but sills.
  const double sill = std::clamp(reach.from - config.floor_gap_m + config.sill_max_m, z.from, z.to);
  const std::vector<double> levels = {z.from, sill, 0.5 * (sill + z.to), z.to};
  for (std::size_t i = 0; i + 1 < levels.size(); ++i) {
    if (levels[i + 1] - levels[i] < 1e-3) continue;
    const double middle = 0.5 * (levels[i] + levels[i + 1]);
    std::vector<bim::WallCut> cuts = bim::section(wall, middle);
    for (const bim::Opening* o : openings) {
      const bool low = o->kind != bim::OpeningKind::window && o->z0_m <= sill;
      if (o->z1_m < middle || (o->z0_m > middle && !low)) continue;
      Interval across = bim::extent_across(frame, bim::solids_of(*o));
      if (across.length() < 0.0) across = {wall.offset_m, wall.offset_m + wall.thickness_m};
      const double half = 0.5 * o->width_m, past = 2.0 * config.shell_m;
      cuts = beside(cuts, Eigen::AlignedBox2d(Eigen::Vector2d(o->s_m - half, across.low - past),
                                              Eigen::Vector2d(o->s_m + half, across.high + past)));
    }
    for (const bim::WallCut& cut : cuts) {
      const Eigen::Vector2d d = cut.b - cut.a, middle_W = 0.5 * (cut.a + cut.b);
      const Eigen::Vector3d center = frame.to_world({middle_W.x(), middle_W.y(), middle});
      boxes.push_back(upright_box(center.head<2>(), yaw + std::atan2(d.y(), d.x()),
                                  {0.5 * d.norm() + config.shell_m, config.shell_m}, {levels[i], levels[i + 1]}));
    }
  }
}

void add_wall(const bim::Building& building, int index, const std::vector<HeightRange>& reaches,
              const CollisionConfig& config, std::vector<CollisionBox>& boxes) {
  const bim::Wall& wall = building.walls[static_cast<std::size_t>(index)];
  std::vector<const bim::Opening*> openings;
  for (const bim::Opening& o : building.openings)
    if (o.wall == index && passable(o, wall)) openings.push_back(&o);

  const bool straight = std::all_of(reaches.begin(), reaches.end(), [&](const HeightRange& reach) {
    const Interval z{std::max(reach.from, wall.z0_m), std::min(reach.to, wall.z1_m)};
    return z.length() <= 0.0 || bim::is_straight(wall, bim::openings_of(building, index), z);
  });
  if (!straight) {
    for (const HeightRange& reach : reaches)
      if (overlap({wall.z0_m, wall.z1_m}, reach)) add_wall_body(wall, openings, reach, config, boxes);
    return;
  }

  const Eigen::Vector2d e = wall.direction();
  const double across = wall.offset_m + 0.5 * wall.thickness_m;
  const std::vector<double> cuts = wall_cuts(wall, openings, config.length_max_m);
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    const double s = 0.5 * (cuts[i] + cuts[i + 1]);
    const Eigen::Vector2d center = wall.a + s * e + across * wall.left();
    for (const HeightRange& z : solid_heights(wall, openings, s))
      if (std::any_of(reaches.begin(), reaches.end(), [&](const HeightRange& reach) {
            return overlap(z, reach) && !is_sill(z, openings, s, reach, config);
          }))
        boxes.push_back(
            upright_box(center, std::atan2(e.y(), e.x()), {0.5 * (cuts[i + 1] - cuts[i]), 0.5 * wall.thickness_m}, z));
  }
}

/// Where a robot may come: around rooms and walls of the storeys, or around their floors where there are neither.
Eigen::AlignedBox2d area_of(const bim::Building& building, const std::vector<int>& storeys) {
  constexpr double margin_m = 2.0;
  const auto among = [&](int storey) { return std::find(storeys.begin(), storeys.end(), storey) != storeys.end(); };
  Eigen::AlignedBox2d area;
  for (const bim::Room& room : building.rooms)
    if (among(room.storey))
      for (const Eigen::Vector2d& p : room.polygon) area.extend(p);
  for (const bim::Wall& wall : building.walls)
    if (among(wall.storey)) area.extend(wall.a).extend(wall.b);
  if (area.isEmpty())
    for (const bim::Slab& slab : building.slabs)
      for (const Eigen::Vector2d& p : slab.polygon.outer)
        if (among(slab.storey)) area.extend(p);
  const Eigen::Vector2d margin = Eigen::Vector2d::Constant(margin_m);
  return area.isEmpty() ? area : Eigen::AlignedBox2d(area.min() - margin, area.max() + margin);
}

}  // namespace

double distance(const CollisionBox& box, const Eigen::Vector3d& p_W) {
  const Eigen::Vector3d p_B = box.X_WB.inverse() * p_W;
  return (p_B.cwiseAbs() - box.half).cwiseMax(0.0).norm();
}

bool is_walked(const bim::Stair& stair, const std::vector<int>& storeys) {
  const auto among = [&](int storey) { return std::find(storeys.begin(), storeys.end(), storey) != storeys.end(); };
  return !stair.flights.empty() && among(stair.from) && among(stair.to);
}

std::vector<CollisionBox> collision_boxes(const bim::Building& as_built, const std::vector<int>& storeys,
                                          const CollisionConfig& config) {
  std::vector<bim::WalkedFloors> floors;
  for (const int storey : storeys) floors.push_back(bim::walked_floors(as_built, storey));
  const auto is_walked_ramp = [&](int obstacle) {
    return std::any_of(floors.begin(), floors.end(), [&](const bim::WalkedFloors& of_storey) {
      return std::any_of(of_storey.raised.begin(), of_storey.raised.end(),
                         [&](const bim::RaisedFloor& floor) { return floor.obstacle == obstacle; });
    });
  };
  const std::vector<HeightRange> reaches = touchable(floors, config);
  const auto reached = [&](const HeightRange& z) {
    return std::any_of(reaches.begin(), reaches.end(), [&](const HeightRange& reach) { return overlap(z, reach); });
  };
  const Eigen::AlignedBox2d area = area_of(as_built, storeys);
  std::vector<CollisionBox> boxes;
  const auto add_solid = [&](const bim::Solid& solid) {
    for (const HeightRange& reach : reaches)
      for (const CollisionBox& box : solid_boxes(solid, reach, area, config)) boxes.push_back(box);
  };
  for (std::size_t i = 0; i < as_built.walls.size(); ++i)
    add_wall(as_built, static_cast<int>(i), reaches, config, boxes);
  for (const bim::Column& column : as_built.columns) {
    if (column.body)
      add_solid(*column.body);
    else if (!column.footprint.empty() && reached({column.z0_m, column.z1_m}))
      boxes.push_back(bounding_box(column.footprint, {column.z0_m, column.z1_m}));
  }
  for (const bim::Stair& stair : as_built.stairs)
    if (!is_walked(stair, storeys))
      for (const bim::Solid& body : stair.bodies) add_solid(body);
  for (std::size_t i = 0; i < as_built.obstacles.size(); ++i)
    if (!is_walked_ramp(static_cast<int>(i))) add_solid(as_built.obstacles[i].body);
  for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i].id = static_cast<int>(i);
  return boxes;
}

}  // namespace plumbline::sim
