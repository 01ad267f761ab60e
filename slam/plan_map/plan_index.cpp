// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_map/plan_index.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>

#include "bim/errors.h"
#include "slam/plan_map/furniture_rows.h"
#include "slam/plan_map/plan_mesh.h"
#include "slam/plan_map/pose2.h"
#include "slam/plan_map/upright.h"
#include "slam/plan_map/wall_lines.h"

namespace plumbline::slam {

namespace {

// Faces that reach into a storey by less belong to the one above or below.
constexpr double sliver_m = 0.05;

/// The room that anchors frame I: smallest name, then lowest index.
const bim::PlanRoom& anchor_room(const bim::Plan& plan) {
  const auto room = std::min_element(plan.rooms.begin(), plan.rooms.end(),
                                     [](const bim::PlanRoom& a, const bim::PlanRoom& b) { return a.name < b.name; });
  if (room == plan.rooms.end() || room->polygon.size() < 3)
    throw InputError({}, "the plan has no rooms, and plan localization starts from rooms; add rooms to the plan");
  return *room;
}

Pose plan_fixed_frame(const bim::Plan& plan_W) {
  const bim::PlanRoom& room = anchor_room(plan_W);
  const Eigen::Vector2d edge = room.polygon[1] - room.polygon[0];
  const double floor = plan_W.storeys.at(static_cast<std::size_t>(room.storey)).elevation_m;
  return Pose::from_xyz_yaw({room.polygon[0].x(), room.polygon[0].y(), floor}, std::atan2(edge.y(), edge.x()));
}

std::vector<int> storeys_in_use(const bim::Plan& plan, const std::optional<std::string>& name) {
  std::vector<int> storeys;
  for (int i = 0; i < static_cast<int>(plan.storeys.size()); ++i) {
    const bool in_use = !name || plan.storeys[static_cast<std::size_t>(i)].name == *name;
    const bool has_room =
        std::any_of(plan.rooms.begin(), plan.rooms.end(), [&](const bim::PlanRoom& room) { return room.storey == i; });
    if (in_use && has_room) storeys.push_back(i);
  }
  if (storeys.empty())
    throw InputError({}, name ? "storey '" + *name + "' is not in the plan or has no rooms to start in"
                              : std::string("no storey of the plan has rooms to start in"));
  return storeys;
}

PlanSegment segment_in_I(const bim::PlanFace& face, int index, const Pose2& X_IW, double base_z) {
  PlanSegment segment = upright(face.p0, face.p1, face.z0, face.z1, X_IW, base_z);
  segment.plan_face = index;
  for (const bim::FaceHole& hole : face.holes)
    segment.holes.push_back({snap(hole.s0), snap(hole.s1), snap(hole.z0 - base_z), snap(hole.z1 - base_z)});
  return segment;
}

/// Numbers of the walls and solids of a plan, in the order of the calls.
class Elements {
 public:
  [[nodiscard]] int of_wall(const bim::PlanFace& face) {
    if (face.wall_id.empty()) return next();
    return of_wall_.try_emplace(face.wall_id, count_).second ? next() : of_wall_.at(face.wall_id);
  }
  [[nodiscard]] int next() { return count_++; }

 private:
  std::map<std::string, int> of_wall_;
  int count_ = 0;
};

/// Calls each element by its first segment.
void number_elements(std::vector<PlanSegment>& segments) {
  std::map<int, int> first;
  for (std::size_t i = 0; i < segments.size(); ++i)
    segments[i].element = first.try_emplace(segments[i].element, static_cast<int>(i)).first->second;
}

/// Faces and sides of solids that stand between floor and ceiling, ordered by geometry, so that the order in the plan
/// does not matter.
std::vector<PlanSegment> storey_segments(const bim::Plan& plan, const Pose& X_WI, double floor_z, double ceiling_z,
                                         bool furniture) {
  const Pose2 X_IW = heading(X_WI).inverse();
  std::vector<PlanSegment> segments;
  Elements elements;
  const auto add = [&](PlanSegment segment, int element) {
    segment.element = element;
    if (segment.z0 < ceiling_z - sliver_m && segment.z1 > floor_z + sliver_m) segments.push_back(std::move(segment));
  };
  for (std::size_t i = 0; i < plan.faces.size(); ++i)
    if ((plan.faces[i].p1 - plan.faces[i].p0).norm() >= 1e-3)
      add(segment_in_I(plan.faces[i], static_cast<int>(i), X_IW, X_WI.t.z()), elements.of_wall(plan.faces[i]));
  for (const bim::PlanSolid& solid : plan.solids) {
    if (solid.may_have_moved && !furniture) continue;
    const int element = elements.next();
    for (PlanSegment& side : sides_of(solid, X_IW, X_WI.t.z())) add(std::move(side), element);
  }
  sort_by_geometry(segments);
  number_elements(segments);
  return segments;
}

/// Lines whose front a ray from p hits.
void add_visible(const StoreyIndex& storey, const PlanIndexConfig& config, const Eigen::Vector2d& p,
                 std::vector<bool>& seen) {
  const int cell = storey.grid.cell_at(p);
  for (int k = 0; k < config.visibility_rays; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / config.visibility_rays;
    const PlanRay ray{p, {std::cos(angle), std::sin(angle)}, storey.floor_z + config.wall_band_m, 0.0};
    const PlanHit hit = storey.grid.cast(storey.segments, ray, config.visibility_range_m, cell);
    if (hit.segment < 0) continue;
    const PlanSegment& segment = storey.segments[static_cast<std::size_t>(hit.segment)];
    if (segment.line >= 0 && segment.n.dot(ray.direction) < 0.0) seen[static_cast<std::size_t>(segment.line)] = true;
  }
}

std::vector<std::vector<int>> visible_lines(const StoreyIndex& storey, const PlanIndexConfig& config) {
  std::vector<std::vector<int>> visible(static_cast<std::size_t>(storey.grid.cells()));
  const double offset = 0.4 * storey.grid.cell_size();
  for (int cell = 0; cell < storey.grid.cells(); ++cell) {
    const Eigen::Vector2d center = storey.grid.cell_center(cell);
    std::vector<bool> seen(storey.lines.size(), false);
    for (const Eigen::Vector2d& shift : {Eigen::Vector2d(0, 0), Eigen::Vector2d(-1, -1), Eigen::Vector2d(1, -1),
                                         Eigen::Vector2d(-1, 1), Eigen::Vector2d(1, 1)})
      add_visible(storey, config, center + offset * shift, seen);
    for (std::size_t i = 0; i < seen.size(); ++i)
      if (seen[i]) visible[static_cast<std::size_t>(cell)].push_back(static_cast<int>(i));
  }
  return visible;
}

/// Leaves out what no robot in any room sees; a stray element would make the grids as large as its distance.
void drop_out_of_sight(std::vector<PlanSegment>& segments, const std::vector<LocalRoom>& rooms) {
  constexpr double sight_m = 100.0;  // range of a VLP-16
  Eigen::AlignedBox2d box;
  for (const LocalRoom& room : rooms)
    for (const Eigen::Vector2d& p : room.polygon) box.extend(p);
  if (box.isEmpty()) return;
  std::erase_if(segments, [&](const PlanSegment& s) {
    return Eigen::AlignedBox2d(s.a).extend(s.a + s.length * s.e).exteriorDistance(box) > sight_m;
  });
  number_elements(segments);
}

std::shared_ptr<const Structure> structure_in_I(bim::BuildingMesh mesh, const Pose& X_WI) {
  if (mesh.triangles.empty()) return nullptr;
  const Pose X_IW = X_WI.inverse();
  for (Eigen::Vector3d& p : mesh.vertices) {
    const Eigen::Vector3d p_I = X_IW * p;
    p = {snap(p_I.x()), snap(p_I.y()), snap(p_I.z())};
  }
  return std::make_shared<const Structure>(mesh);
}

bim::WalkedFloors floors_in_I(bim::WalkedFloors floors, const Pose& X_WI) {
  floors = bim::moved(X_WI.inverse(), std::move(floors));
  floors.ground_m = snap(floors.ground_m);
  for (bim::RaisedFloor& floor : floors.raised) {
    for (Eigen::Vector2d& p : floor.polygon.outer) p = snap(p);
    for (Polygon2& hole : floor.polygon.holes)
      for (Eigen::Vector2d& p : hole) p = snap(p);
    floor.z_m = snap(floor.z_m);
    floor.z0_m = snap(floor.z0_m);
    for (double& rise : floor.slope) rise = snap(rise);
  }
  return floors;
}

StoreyIndex make_storey(const bim::Plan& plan_W, int plan_storey, const Pose& X_WI, const PlanIndexConfig& config,
                        std::shared_ptr<const Structure> structure, std::shared_ptr<const Structure> furniture) {
  const bim::PlanStorey& source = plan_W.storeys[static_cast<std::size_t>(plan_storey)];
  StoreyIndex storey;
  storey.plan_storey = plan_storey;
  storey.floor_z = snap(source.elevation_m - X_WI.t.z());
  storey.ceiling_z = snap(storey.floor_z + source.height_m);
  if (source.floors) storey.floors = floors_in_I(*source.floors, X_WI);
  const Pose2 X_IW = heading(X_WI).inverse();
  for (std::size_t i = 0; i < plan_W.rooms.size(); ++i) {
    if (plan_W.rooms[i].storey != plan_storey) continue;
    LocalRoom room{static_cast<int>(i), plan_W.rooms[i].name, {}};
    for (const Eigen::Vector2d& p_W : plan_W.rooms[i].polygon) room.polygon.push_back(snap(X_IW * p_W));
    storey.rooms.push_back(std::move(room));
  }
  storey.segments = storey_segments(plan_W, X_WI, storey.floor_z, storey.ceiling_z, config.furniture);
  drop_out_of_sight(storey.segments, storey.rooms);
  storey.lines = merge_wall_lines(storey.segments, storey.floor_z + config.wall_band_m, config);
  storey.grid = SegmentGrid(storey.segments, config.cell_m);
  storey.sectors = FaceSectors(storey.segments, storey.grid.ray_candidates(), storey.grid.cells());
  storey.visible = visible_lines(storey, config);
  if (!config.furniture) storey.rows = furniture_rows(plan_W, X_WI, storey.floor_z, storey.ceiling_z, config);
  storey.structure = structure ? std::move(structure) : std::make_shared<const Structure>(plan_mesh(storey));
  storey.furniture = std::move(furniture);
  return storey;
}

}  // namespace

std::vector<Plane> StoreyIndex::floor_planes() const {
  std::vector<Plane> planes = {{Eigen::Vector3d::UnitZ(), -lowest_floor()}};
  if (!floors) return planes;
  for (const bim::RaisedFloor& floor : floors->raised) {
    const Eigen::Vector3d upward = Eigen::Vector3d(-floor.slope.x(), -floor.slope.y(), 1.0);
    planes.push_back({upward.normalized(), -floor.z0_m / upward.norm()});
  }
  return planes;
}

int StoreyIndex::room_at(const Eigen::Vector2d& p) const {
  for (std::size_t i = 0; i < rooms.size(); ++i)
    if (contains(rooms[i].polygon, p)) return static_cast<int>(i);
  return -1;
}

bool StoreyIndex::has_floor_at(const Eigen::Vector2d& p_I) const {
  constexpr double doorway_m = 0.3;  // from a room, in a wall of twice that
  constexpr double reach_m = 0.3;    // up and down: uneven floors, thresholds
  const double z = floor_at(p_I) + reach_m;
  return structure->ground_below({p_I.x(), p_I.y(), z}, 2.0 * reach_m) || room_at(p_I) >= 0 ||
         std::any_of(rooms.begin(), rooms.end(),
                     [&](const LocalRoom& room) { return boundary_distance(room.polygon, p_I) <= doorway_m; });
}

double PlanIndex::free_area() const {
  double area = 0.0;
  for (const StoreyIndex& storey : storeys)
    for (const LocalRoom& room : storey.rooms) area += std::abs(signed_area(room.polygon));
  return area;
}

PlanIndex make_plan_index(const bim::Plan& plan_W, const std::optional<std::string>& storey,
                          const PlanIndexConfig& config) {
  PlanIndex index;
  index.config = config;
  index.X_WI = plan_fixed_frame(plan_W);
  const std::shared_ptr<const Structure> structure = structure_in_I(plan_W.structure, index.X_WI),
                                         furniture = structure_in_I(plan_W.furniture, index.X_WI);
  for (const int i : storeys_in_use(plan_W, storey))
    index.storeys.push_back(make_storey(plan_W, i, index.X_WI, config, structure, furniture));
  return index;
}

int add_storey(PlanIndex& index, const bim::Plan& plan_W, int plan_storey) {
  const StoreyIndex& first = index.storeys.front();
  // Without one the structure of a storey is its walls.
  const std::shared_ptr<const Structure> structure = plan_W.structure.triangles.empty() ? nullptr : first.structure;
  index.storeys.push_back(make_storey(plan_W, plan_storey, index.X_WI, index.config, structure, first.furniture));
  return static_cast<int>(index.storeys.size()) - 1;
}

}  // namespace plumbline::slam
