// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include "bim/building/stair_shape.h"
#include "bim/errors.h"
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

using Points = std::vector<Eigen::Vector2d>;

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
    out.push_back(bounding_box(landing.polygon, {landing.z_m - config.floor_body_m, landing.z_m}));
}

/// Everything below the head of a stair that is not floor of the upper storey.
class Well {
 public:
  Well(const bim::Building& building, const bim::Stair& stair, const BuildingGroundConfig& config)
      : config_(config), yaw_(stair.flights.front().yaw), level_(building.storeys[index(stair.to)].elevation_m) {
    for (const bim::StairFlight& flight : stair.flights)
      outlines_.push_back(bim::steps_outline(flight, 0, flight.steps - 1));
    for (const bim::Landing& landing : stair.landings) outlines_.push_back(landing.polygon);
    for (const Polygon2& outline : outlines_)
      for (const Eigen::Vector2d& p : outline) bounds_F_.extend(to_frame(p));
    bounds_F_.min().array() -= config.well_margin_m;
    bounds_F_.max().array() += config.well_margin_m;
    for (const bim::Slab& slab : building.slabs)
      if (slab.z1_m > level_ - config.level_m && slab.z1_m < level_ + 0.1 * config.level_m) slabs_.push_back(&slab);
  }

  [[nodiscard]] Eigen::AlignedBox2d bounds_W() const {
    Eigen::AlignedBox2d box;
    for (int i = 0; i < 4; ++i) box.extend(to_world(bounds_F_.corner(static_cast<Eigen::AlignedBox2d::CornerType>(i))));
    return box;
  }

  /// Floor around the well as boxes: rows of cells inside its bounds, four boxes around them.
  void add_floor(double reach_m, std::vector<CollisionBox>& out) const {
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

  static std::size_t index(int i) { return static_cast<std::size_t>(i); }

  [[nodiscard]] Eigen::Vector2d to_frame(const Eigen::Vector2d& p_W) const { return Eigen::Rotation2Dd(-yaw_) * p_W; }
  [[nodiscard]] Eigen::Vector2d to_world(const Eigen::Vector2d& p_F) const { return Eigen::Rotation2Dd(yaw_) * p_F; }

  /// Where no slab is known the floor is all that is not stair.
  [[nodiscard]] bool floor_at(const Eigen::Vector2d& p_W) const {
    const auto covers = [&](const bim::Slab* slab) {
      const auto in = [&](const Polygon2& polygon) { return plumbline::contains(polygon, p_W); };
      return in(slab->polygon.outer) && std::none_of(slab->polygon.holes.begin(), slab->polygon.holes.end(), in);
    };
    if (!slabs_.empty()) return std::any_of(slabs_.begin(), slabs_.end(), covers);
    return std::none_of(outlines_.begin(), outlines_.end(),
                        [&](const Polygon2& outline) { return plumbline::contains(outline, p_W); });
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
  double yaw_;
  double level_;
  std::vector<Polygon2> outlines_;
  Eigen::AlignedBox2d bounds_F_;  ///< in the plane turned by yaw_
  std::vector<const bim::Slab*> slabs_;
};

/// Low walls under passable doors.
void add_sills(const bim::Building& building, double floor_z, const BuildingGroundConfig& config,
               std::vector<CollisionBox>& out) {
  const CollisionConfig collision;
  for (const bim::Opening& o : building.openings) {
    if (o.kind == bim::OpeningKind::window || o.leaf == bim::Leaf::closed) continue;
    if (o.z0_m < floor_z + config.sill_min_m || o.z0_m > floor_z + collision.sill_max_m) continue;
    const bim::Wall& wall = building.walls[static_cast<std::size_t>(o.wall)];
    const Eigen::Vector2d e = wall.direction();
    const Eigen::Vector2d center = wall.a + o.s_m * e + (wall.offset_m + 0.5 * wall.thickness_m) * wall.left();
    out.push_back(upright_box(center, std::atan2(e.y(), e.x()), {0.5 * o.width_m, 0.5 * wall.thickness_m},
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
    GroundLevel level{as_built.storeys[static_cast<std::size_t>(storey)].elevation_m, {}};
    for (const bim::Stair& stair : as_built.stairs) {
      if (stair.to != storey || !is_walked(stair, storeys)) continue;
      const Well well(as_built, stair, config);
      level.wells_W.push_back(well.bounds_W());
      well.add_floor(well_config.boxes_to_m, surfaces);
    }
    add_sills(as_built, level.z_m, config, surfaces);
    levels.push_back(std::move(level));
  }
  if (levels.empty()) throw InputError({}, "a robot needs a storey to stand on");
  for (const bim::Stair& stair : as_built.stairs)
    if (is_walked(stair, storeys)) add_steps(stair, config, surfaces);
  std::stable_sort(levels.begin(), levels.end(), [](const auto& a, const auto& b) { return a.z_m < b.z_m; });
  return {std::move(levels), std::move(surfaces), well_config};
}

}  // namespace plumbline::sim
