// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "bim/errors.h"
#include "bim/model/boxes.h"
#include "bim/model/stair_flight.h"
#include "bim/model/through.h"
#include "bim/model/walked_floors.h"
#include "bim/model/wall_frame.h"
#include "sim/robot/ground.h"
#include "sim/robot/solid_boxes.h"

namespace plumbline::sim {

namespace {

struct BuildingGroundConfig {
  double step_body_m = 0.15;   ///< of a step below the one before it
  double floor_body_m = 0.25;  ///< of the floor around a well
  double cell_m = 0.05;        ///< edges of a well are found to half of this
  double well_margin_m = 0.5;  ///< a well is open at most so far beside its stair
  double level_m = 0.35;       ///< the raw slab of a storey lies so close below its floor
  double sill_min_m = 0.003;   ///< a lower sill is no sill
};

/// Whether four corners make a rectangle.
bool is_rectangle(const PolygonWithHoles2& polygon) {
  const Polygon2& p = polygon.outer;
  if (p.size() != 4 || !polygon.holes.empty()) return false;
  return ((p[0] + p[2]) - (p[1] + p[3])).norm() < 1e-3 && std::abs((p[2] - p[0]).norm() - (p[3] - p[1]).norm()) < 1e-3;
}

/// The direction of a polygon's longest edge (ties: the first), less whole quarter turns.
double yaw_of(const Polygon2& polygon) {
  constexpr double level = 1e-9;
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();
  double longest = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d edge = polygon[(i + 1) % polygon.size()] - polygon[i];
    if (edge.norm() <= longest + level) continue;
    longest = edge.norm();
    along = edge.normalized();
  }
  while (along.x() <= level || along.y() < -level) along = {-along.y(), along.x()};
  return along.y() < level ? 0.0 : std::atan2(along.y(), along.x());
}

PolygonWithHoles2 turned(PolygonWithHoles2 polygon, const Eigen::Rotation2Dd& turn) {
  for (Eigen::Vector2d& p : polygon.outer) p = turn * p;
  for (Polygon2& hole : polygon.holes)
    for (Eigen::Vector2d& p : hole) p = turn * p;
  return polygon;
}

/// Runs of cells along x inside a polygon; rows with the same runs are one rectangle.
std::vector<Eigen::AlignedBox2d> rows_of(const PolygonWithHoles2& polygon, double cell_m) {
  std::vector<Eigen::AlignedBox2d> out;
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : polygon.outer) box.extend(p);
  const Eigen::Vector2i count = (box.sizes() / cell_m).array().ceil().cast<int>();
  const Eigen::Vector2d cell = box.sizes().cwiseQuotient(count.cast<double>());
  using Runs = std::vector<std::pair<int, int>>;
  const auto runs_of = [&](int row) {
    Runs runs;
    for (int i = 0; i < count.x(); ++i) {
      const Eigen::Vector2d p = box.min() + Eigen::Vector2d((i + 0.5) * cell.x(), (row + 0.5) * cell.y());
      const auto in = [&](const Polygon2& ring) { return contains(ring, p); };
      if (!in(polygon.outer) || std::any_of(polygon.holes.begin(), polygon.holes.end(), in)) continue;
      if (!runs.empty() && runs.back().second == i)
        ++runs.back().second;
      else
        runs.emplace_back(i, i + 1);
    }
    return runs;
  };
  Runs open;
  int open_from = 0;
  for (int row = 0; row <= count.y(); ++row) {
    const Runs here = row < count.y() ? runs_of(row) : Runs{};
    if (row < count.y() && here == open) continue;
    for (const auto& [from, to] : open) {
      const Eigen::Vector2d low = box.min() + Eigen::Vector2d(from * cell.x(), open_from * cell.y());
      const Eigen::Vector2d high = box.min() + Eigen::Vector2d(to * cell.x(), row * cell.y());
      out.emplace_back(low, high);
    }
    open = here;
    open_from = row;
  }
  return out;
}

/// A level floor: the box over a rectangle, or cells along the longest edge of what is none.
void add_level(const PolygonWithHoles2& polygon, const HeightRange& z, const BuildingGroundConfig& config,
               std::vector<CollisionBox>& out) {
  const double yaw = yaw_of(polygon.outer);
  if (is_rectangle(polygon)) {
    out.push_back(box_along(polygon.outer, yaw, z));
    return;
  }
  const Eigen::Rotation2Dd turn(yaw);
  for (const Eigen::AlignedBox2d& row : rows_of(turned(polygon, turn.inverse()), config.cell_m))
    out.push_back(upright_box(turn * row.center(), yaw, 0.5 * row.sizes(), z));
}

/// Flights and landings of a stair as boxes one walks on.
void add_steps(const bim::Stair& stair, const BuildingGroundConfig& config, std::vector<CollisionBox>& out) {
  for (const bim::StairFlight& flight : stair.flights) {
    const Eigen::Vector2d e(std::cos(flight.yaw), std::sin(flight.yaw));
    for (int k = 0; k < flight.steps; ++k) {
      const double z = flight.z0_m + (k + 1) * flight.rise_m;
      out.push_back(upright_box(flight.start + (k + 0.5) * flight.run_m * e, flight.yaw,
                                {0.5 * flight.run_m, 0.5 * flight.width_m},
                                {z - flight.rise_m - config.step_body_m, z}));
    }
  }
  for (const bim::Landing& landing : stair.landings)
    add_level({landing.polygon, {}}, {landing.z_m - config.floor_body_m, landing.z_m}, config, out);
}

/// Everything below the head of a stair that is not floor of the upper storey.
class Well {
 public:
  Well(const bim::Building& building, const bim::Stair& stair, const BuildingGroundConfig& config)
      : yaw_(stair.flights.front().yaw) {
    for (const bim::StairFlight& flight : stair.flights)
      outlines_.push_back(bim::steps_outline(flight, 0, flight.steps - 1));
    for (const bim::Landing& landing : stair.landings) outlines_.push_back(landing.polygon);
    for (const Polygon2& outline : outlines_)
      for (const Eigen::Vector2d& p : outline) bounds_F_.extend(to_frame(p));
    bounds_F_.min().array() -= config.well_margin_m;
    bounds_F_.max().array() += config.well_margin_m;
    const double level = building.storeys[static_cast<std::size_t>(stair.to)].elevation_m;
    for (const bim::Slab& slab : building.slabs)
      if (slab.z1_m > level - config.level_m && slab.z1_m < level + 0.1 * config.level_m) slabs_.push_back(&slab);
  }

  [[nodiscard]] double yaw() const { return yaw_; }

  [[nodiscard]] std::array<Eigen::Vector2d, 4> corners_W() const {
    std::array<Eigen::Vector2d, 4> corners;
    for (int i = 0; i < 4; ++i)
      corners[static_cast<std::size_t>(i)] =
          Eigen::Rotation2Dd(yaw_) * bounds_F_.corner(static_cast<Eigen::AlignedBox2d::CornerType>(i));
    return corners;
  }

  [[nodiscard]] Eigen::AlignedBox2d bounds_W() const {
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& corner : corners_W()) box.extend(corner);
    return box;
  }

  /// Outside the well everything is floor; inside it, in a building without slabs, all that is not stair.
  [[nodiscard]] bool floor_at(const Eigen::Vector2d& p_W) const {
    if (!bounds_F_.contains(to_frame(p_W))) return true;
    const auto covers = [&](const bim::Slab* slab) {
      const auto in = [&](const Polygon2& polygon) { return plumbline::contains(polygon, p_W); };
      return in(slab->polygon.outer) && std::none_of(slab->polygon.holes.begin(), slab->polygon.holes.end(), in);
    };
    if (!slabs_.empty()) return std::any_of(slabs_.begin(), slabs_.end(), covers);
    return std::none_of(outlines_.begin(), outlines_.end(),
                        [&](const Polygon2& outline) { return plumbline::contains(outline, p_W); });
  }

 private:
  [[nodiscard]] Eigen::Vector2d to_frame(const Eigen::Vector2d& p_W) const { return Eigen::Rotation2Dd(-yaw_) * p_W; }

  double yaw_;
  std::vector<Polygon2> outlines_;
  Eigen::AlignedBox2d bounds_F_;  ///< in the plane turned by yaw_
  std::vector<const bim::Slab*> slabs_;
};

/// Floor around wells of one level that are so near each other that what surrounds one would cover another.
class FloorAround {
 public:
  FloorAround(std::vector<Well> wells, double level_m, const BuildingGroundConfig& config)
      : config_(config), wells_(std::move(wells)), yaw_(wells_.front().yaw()), level_(level_m) {
    for (const Well& well : wells_)
      for (const Eigen::Vector2d& corner : well.corners_W()) bounds_F_.extend(Eigen::Rotation2Dd(-yaw_) * corner);
  }

  /// Adds boxes: rows of cells inside the bounds of the wells, four boxes around them.
  void add_to(std::vector<CollisionBox>& out, double reach_m) const {
    const Eigen::Vector2d low = bounds_F_.min();
    const Eigen::Vector2d high = bounds_F_.max();
    const Eigen::Vector2d far_low = low.array() - reach_m;
    const Eigen::Vector2d far_high = high.array() + reach_m;
    add_rows(out);
    add_box(far_low, {far_high.x(), low.y()}, out);
    add_box({far_low.x(), high.y()}, far_high, out);
    add_box({far_low.x(), low.y()}, {low.x(), high.y()}, out);
    add_box({high.x(), low.y()}, {far_high.x(), high.y()}, out);
  }

 private:
  struct Run {
    int from = 0;
    int to = 0;
    bool operator==(const Run&) const = default;
  };

  [[nodiscard]] Eigen::Vector2d to_world(const Eigen::Vector2d& p_F) const { return Eigen::Rotation2Dd(yaw_) * p_F; }

  [[nodiscard]] bool floor_at(const Eigen::Vector2d& p_W) const {
    return std::all_of(wells_.begin(), wells_.end(), [&](const Well& well) { return well.floor_at(p_W); });
  }

  [[nodiscard]] std::vector<Run> runs(int row, int columns, const Eigen::Vector2d& cell) const {
    std::vector<Run> out;
    for (int i = 0; i < columns; ++i) {
      const Eigen::Vector2d p_F = bounds_F_.min() + Eigen::Vector2d((i + 0.5) * cell.x(), (row + 0.5) * cell.y());
      if (!floor_at(to_world(p_F))) continue;
      if (!out.empty() && out.back().to == i)
        ++out.back().to;
      else
        out.push_back({i, i + 1});
    }
    return out;
  }

  /// Rows with the same runs are one.
  void add_rows(std::vector<CollisionBox>& out) const {
    const Eigen::Vector2d size = bounds_F_.sizes();
    const Eigen::Vector2i count = (size / config_.cell_m).array().ceil().cast<int>();
    const Eigen::Vector2d cell = size.cwiseQuotient(count.cast<double>());
    std::vector<Run> open;
    int open_from = 0;
    for (int row = 0; row <= count.y(); ++row) {
      const std::vector<Run> here = row < count.y() ? runs(row, count.x(), cell) : std::vector<Run>{};
      if (row < count.y() && here == open) continue;
      for (const Run& run : open)
        add_box(bounds_F_.min() + Eigen::Vector2d(run.from * cell.x(), open_from * cell.y()),
                bounds_F_.min() + Eigen::Vector2d(run.to * cell.x(), row * cell.y()), out);
      open = here;
      open_from = row;
    }
  }

  void add_box(const Eigen::Vector2d& low_F, const Eigen::Vector2d& high_F, std::vector<CollisionBox>& out) const {
    out.push_back(upright_box(to_world(0.5 * (low_F + high_F)), yaw_, 0.5 * (high_F - low_F),
                              {level_ - config_.floor_body_m, level_}));
  }

  BuildingGroundConfig config_;
  std::vector<Well> wells_;
  double yaw_;
  double level_;
  Eigen::AlignedBox2d bounds_F_;  ///< of all wells, in the plane turned by yaw_
};

/// Wells in groups: whose surroundings, up to reach_m, meet a well of the group belongs to it.
std::vector<std::vector<Well>> grouped(const std::vector<Well>& wells, double reach_m) {
  std::vector<std::vector<Well>> groups;
  const auto meet = [&](const Well& a, const Well& b) {
    Eigen::AlignedBox2d around = a.bounds_W();
    around.min().array() -= reach_m;
    around.max().array() += reach_m;
    return around.intersects(b.bounds_W());
  };
  for (const Well& well : wells) {
    std::vector<Well> joined = {well};
    std::vector<std::vector<Well>> apart;
    for (std::vector<Well>& group : groups) {
      const bool near = std::any_of(group.begin(), group.end(), [&](const Well& other) { return meet(well, other); });
      if (near)
        joined.insert(joined.begin(), group.begin(), group.end());
      else
        apart.push_back(std::move(group));
    }
    apart.push_back(std::move(joined));
    groups = std::move(apart);
  }
  return groups;
}

/// A sloping floor as boxes that lean along its slope.
void add_sloping(const bim::RaisedFloor& floor, const BuildingGroundConfig& config, std::vector<CollisionBox>& out) {
  const double yaw = std::atan2(floor.slope.y(), floor.slope.x()), tangent = floor.slope.norm(),
               secant = std::hypot(1.0, tangent);
  const Eigen::Rotation2Dd turn(yaw), back(-yaw);
  const PolygonWithHoles2 in_slope = turned(floor.polygon, back);
  const Eigen::Quaterniond q_WB = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(-std::atan(tangent), Eigen::Vector3d::UnitY());
  const bool upright = is_rectangle(in_slope) && std::abs((in_slope.outer[1] - in_slope.outer[0]).prod()) < 1e-6;
  std::vector<Eigen::AlignedBox2d> rows =
      upright ? std::vector{bim::box_of(in_slope.outer)} : rows_of(in_slope, config.cell_m);
  for (const Eigen::AlignedBox2d& row : rows) {
    const Eigen::Vector2d center = turn * row.center();
    CollisionBox box;
    box.half = {0.5 * row.sizes().x() * secant, 0.5 * row.sizes().y(), 0.5 * config.floor_body_m};
    const Eigen::Vector3d top(center.x(), center.y(), floor.z_at(center));
    box.X_WB = {q_WB, top - q_WB * Eigen::Vector3d(0.0, 0.0, box.half.z())};
    out.push_back(box);
  }
}

/// Raised floors, each down to below the ground.
void add_raised(const bim::WalkedFloors& floors, const BuildingGroundConfig& config, std::vector<CollisionBox>& out) {
  for (const bim::RaisedFloor& floor : floors.raised) {
    const HeightRange z{floors.ground_m - config.floor_body_m, floor.z_m};
    if (!floor.is_level())
      add_sloping(floor, config, out);
    else
      add_level(floor.polygon, z, config, out);
  }
}

/// Low walls under passable doors.
void add_sills(const bim::Building& building, double floor_z, const BuildingGroundConfig& config,
               std::vector<CollisionBox>& out) {
  const CollisionConfig collision;
  for (const bim::Opening& o : building.openings) {
    if (o.kind == bim::OpeningKind::window || o.leaf == bim::Leaf::closed) continue;
    if (o.z0_m < floor_z + config.sill_min_m || o.z0_m > floor_z + collision.sill_max_m) continue;
    const bim::Wall& wall = building.walls[static_cast<std::size_t>(o.wall)];
    if (!bim::goes_through(o, wall)) continue;
    const Eigen::Vector2d e = wall.direction();
    const Interval depth = bim::depth_in_wall(o, wall);
    const Eigen::Vector2d center = wall.a + o.s_m * e + (depth.low + 0.5 * depth.length()) * wall.left();
    out.push_back(upright_box(center, std::atan2(e.y(), e.x()), {0.5 * o.width_m, 0.5 * depth.length()},
                              {floor_z - config.floor_body_m, o.z0_m}));
  }
}

}  // namespace

Ground building_ground(const bim::Building& as_built, const std::vector<int>& storeys) {
  const BuildingGroundConfig config;
  const WellConfig well_config;
  std::vector<GroundLevel> levels;
  std::vector<CollisionBox> surfaces;
  for (const int storey : storeys) {
    if (storey < 0 || static_cast<std::size_t>(storey) >= as_built.storeys.size())
      throw InputError({}, "the building has no storey number " + std::to_string(storey));
    const bim::WalkedFloors floors = bim::walked_floors(as_built, storey);
    GroundLevel level{floors.ground_m, {}};
    std::vector<Well> wells;
    for (const bim::Stair& stair : as_built.stairs)
      if (stair.to == storey && is_walked(stair, storeys)) wells.emplace_back(as_built, stair, config);
    for (const Well& well : wells) level.wells_W.push_back(well.bounds_W());
    for (std::vector<Well>& group : grouped(wells, well_config.boxes_to_m))
      FloorAround(std::move(group), level.z_m, config).add_to(surfaces, well_config.boxes_to_m);
    add_sills(as_built, level.z_m, config, surfaces);
    add_raised(floors, config, surfaces);
    levels.push_back(std::move(level));
  }
  if (levels.empty()) throw InputError({}, "a robot needs a storey to stand on");
  for (const bim::Stair& stair : as_built.stairs)
    if (is_walked(stair, storeys)) add_steps(stair, config, surfaces);
  std::stable_sort(levels.begin(), levels.end(), [](const auto& a, const auto& b) { return a.z_m < b.z_m; });
  return {std::move(levels), std::move(surfaces), well_config};
}

}  // namespace plumbline::sim
