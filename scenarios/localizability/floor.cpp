// SPDX-License-Identifier: Apache-2.0
#include "scenarios/localizability/floor.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <queue>
#include <string>

#include "bim/errors.h"
#include "bim/geometry/grid_frame.h"
#include "bim/geometry/polygon_boolean.h"
#include "bim/mesh/visible.h"
#include "bim/model/permanence.h"
#include "scenarios/localizability/constants.h"
#include "scenarios/localizability/symmetric_images.h"
#include "sim/route/route.h"

namespace plumbline::scenarios {

namespace {

constexpr double fine_m = 0.1;
constexpr double most_fine = 1 << 24;
constexpr double threshold_m = 0.3;  ///< a doorway belongs to the rooms this near

/// Which places count as floor to be asked about.
class Rooms {
 public:
  Rooms(const bim::Building& building, std::size_t storey) {
    for (const bim::Room& room : building.rooms)
      if (room.storey == static_cast<int>(storey)) rooms_.push_back(&room);
  }
  [[nodiscard]] bool hold(const Eigen::Vector2d& p) const {
    return rooms_.empty() || std::any_of(rooms_.begin(), rooms_.end(), [&](const bim::Room* room) {
             return room->contains(p) || room->boundary_distance(p) <= threshold_m;
           });
  }

 private:
  std::vector<const bim::Room*> rooms_;
};

constexpr std::size_t no_owner = static_cast<std::size_t>(-1);

/// Fine grid over the free space; every node belongs to the cell from which the way to it is shortest.
struct Surroundings {
  GridFrame grid;
  std::vector<std::size_t> owner;
  std::vector<double> distance_m;
};

Surroundings surroundings(const Floor& floor, const SearchArea& area, const sim::ClearanceMap& space) {
  Surroundings s;
  s.grid.cell = fine_m;
  s.grid.origin = area.corner - fine_m * ((area.corner - area.min) / fine_m).array().ceil().matrix();
  const Eigen::Vector2d size = (area.max - s.grid.origin).cwiseMax(0.0) / fine_m;
  if (size.x() * size.y() > most_fine)
    throw InputError({"identify", 0, 0}, "a storey is too large; it must be smaller");
  s.grid.nx = static_cast<int>(std::ceil(size.x()));
  s.grid.ny = static_cast<int>(std::ceil(size.y()));
  s.owner.assign(s.grid.size(), no_owner);
  s.distance_m.assign(s.grid.size(), 1e9);
  using Node = std::tuple<double, std::size_t, std::size_t>;  // way, owner, node
  std::priority_queue<Node, std::vector<Node>, std::greater<>> open;
  for (std::size_t i = 0; i < floor.cells_W.size(); ++i)
    if (const auto node = s.grid.find(floor.cells_W[i])) open.emplace(0.0, i, *node);
  while (!open.empty()) {
    const auto [way, owner, node] = open.top();
    open.pop();
    if (s.owner[node] != no_owner) continue;
    s.owner[node] = owner;
    s.distance_m[node] = way;
    const auto [column, row] = s.grid.column_and_row(node);
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const int x = column + dx, y = row + dy;
        if ((dx == 0 && dy == 0) || !s.grid.holds(x, y)) continue;
        const std::size_t next = s.grid.index(x, y);
        if (s.owner[next] == no_owner && space.free(s.grid.center(next)))
          open.emplace(way + fine_m * std::hypot(dx, dy), owner, next);
      }
  }
  return s;
}

std::vector<FloorLink> links_of(const Floor& floor, const Surroundings& s) {
  std::map<std::pair<std::size_t, std::size_t>, double> shortest;
  for (int y = 0; y < s.grid.ny; ++y)
    for (int x = 0; x < s.grid.nx; ++x)
      for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}, {1, 1}, {-1, 1}}) {
        if (!s.grid.holds(x + dx, y + dy)) continue;
        const std::size_t i = s.grid.index(x, y), j = s.grid.index(x + dx, y + dy);
        const std::size_t a = std::min(s.owner[i], s.owner[j]), b = std::max(s.owner[i], s.owner[j]);
        if (b == no_owner || a == b) continue;
        // The way through the grid turns by 45 degrees at a time; the straight line is what a robot walks at best.
        const double way = std::max((floor.cells_W[a] - floor.cells_W[b]).norm(),
                                    (s.distance_m[i] + s.distance_m[j] + fine_m * std::hypot(dx, dy)) / 1.05);
        const auto [it, fresh] = shortest.emplace(std::pair{a, b}, way);
        if (!fresh) it->second = std::min(it->second, way);
      }
  std::vector<FloorLink> links;
  for (const auto& [pair, way] : shortest) links.push_back({pair.first, pair.second, way});
  return links;
}

bool is_movable(const bim::Building& building, const bim::MeshElement& element) {
  return element.kind == bim::ElementKind::obstacle &&
         bim::may_have_moved(building.obstacles[static_cast<std::size_t>(element.index)]);
}

bool is_assumed(const bim::Building& building, const bim::MeshElement& element) {
  return element.kind == bim::ElementKind::slab && building.slabs[static_cast<std::size_t>(element.index)].assumed;
}

using IsLeftOut = std::function<bool(const bim::Obstacle& planned)>;

/// What of the plan does not count in an answer.
IsLeftOut left_out(const RunBuilding& building, PlanEvidence by) {
  if (by == PlanEvidence::building) return bim::may_have_moved;
  if (by == PlanEvidence::whole_plan || !building.deviates()) return [](const bim::Obstacle&) { return false; };
  return [&](const bim::Obstacle& planned) {
    return bim::may_have_moved(planned) && bim::is_gone(planned, building.as_built());
  };
}

/// The mesh without some obstacles; elements keep their numbers.
bim::BuildingMesh without(const IsLeftOut& is_left_out, const bim::Building& building, const bim::BuildingMesh& mesh) {
  bim::BuildingMesh kept{mesh.vertices, {}, {}, mesh.elements, mesh.warnings};
  for (bim::MeshElement& element : kept.elements) {
    const int first = element.first_triangle;
    element.first_triangle = static_cast<int>(kept.triangles.size());
    if (element.kind == bim::ElementKind::obstacle &&
        is_left_out(building.obstacles[static_cast<std::size_t>(element.index)]))
      element.triangle_count = 0;
    const auto from = mesh.triangles.begin() + first;
    kept.triangles.insert(kept.triangles.end(), from, from + element.triangle_count);
    const auto number = static_cast<int>(&element - kept.elements.data());
    kept.element.insert(kept.element.end(), static_cast<std::size_t>(element.triangle_count), number);
  }
  return kept;
}

VisibleScene visible_scene(const bim::BuildingMesh& visible) {
  std::vector<std::string> elements;
  for (const bim::MeshElement& element : visible.elements) elements.push_back(element.id);
  return {bim::RayScene(visible), std::move(elements)};
}

/// What may have moved, by id.
std::map<std::string, const bim::Obstacle*> movables_of(const bim::Building& building) {
  std::map<std::string, const bim::Obstacle*> found;
  for (const bim::Obstacle& obstacle : building.obstacles)
    if (bim::may_have_moved(obstacle)) found.emplace(obstacle.id, &obstacle);
  return found;
}

/// A building and its mesh as the answers count them.
struct Scanned {
  bim::Building building;
  bim::BuildingMesh mesh;
};

/// Assumed floors, and around those of each storey the same floor as far as a beam reaches: nobody knows where an
/// assumed floor ends, and so its edges tell nothing of a pose.
std::vector<bim::Slab> floors_without_edges(const bim::Building& as_built) {
  std::map<int, std::vector<bim::Slab>> storeys;
  for (const bim::Slab& slab : as_built.slabs)
    if (slab.assumed) storeys[slab.storey].push_back(slab);
  std::vector<bim::Slab> floors;
  for (auto& [storey, assumed] : storeys) {
    Eigen::AlignedBox2d box;
    std::vector<Polygon2> outlines;
    bim::Slab lowest = assumed.front();
    for (const bim::Slab& slab : assumed) {
      outlines.push_back(slab.polygon.outer);
      for (const Eigen::Vector2d& p : slab.polygon.outer) box.extend(p);
      if (slab.z1_m < lowest.z1_m) lowest = slab;
    }
    const Eigen::Vector2d beyond = Eigen::Vector2d::Constant(localizability_constants.range_max_m);
    const Eigen::Vector2d low = box.min() - beyond, high = box.max() + beyond;
    const Polygon2 all = {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
    for (PolygonWithHoles2& piece : subtract(unite(std::vector<Polygon2>{all}), outlines)) {
      bim::Slab around = lowest;
      around.id += "/around/" + std::to_string(floors.size());
      around.polygon = std::move(piece);
      floors.push_back(std::move(around));
    }
    floors.insert(floors.end(), assumed.begin(), assumed.end());
  }
  return floors;
}

Scanned scanned(const bim::Building& building, const bim::BuildingMesh& mesh, const std::vector<bim::Slab>& floors) {
  if (floors.empty()) return {building, mesh};
  Scanned with_floors{building, {}};
  std::vector<bim::Slab>& slabs = with_floors.building.slabs;
  std::erase_if(slabs, [](const bim::Slab& slab) { return slab.assumed; });
  slabs.insert(slabs.end(), floors.begin(), floors.end());
  with_floors.mesh = bim::build_mesh(with_floors.building);
  return with_floors;
}

std::vector<char> loose_elements(const RunBuilding& building, const Scanned& as_built, PlanEvidence by) {
  std::map<std::string, const bim::Obstacle*> counted;
  if (by != PlanEvidence::building) counted = movables_of(building.as_planned());
  const std::vector<bim::Obstacle>& obstacles = as_built.building.obstacles;
  std::vector<char> loose;
  for (const bim::MeshElement& element : as_built.mesh.elements) {
    const auto planned = counted.find(element.id);
    const bool stands =
        planned != counted.end() && element.kind == bim::ElementKind::obstacle &&
        planned->second->body.vertices == obstacles[static_cast<std::size_t>(element.index)].body.vertices;
    loose.push_back(is_movable(as_built.building, element) && !stands ? 1 : 0);
  }
  return loose;
}

}  // namespace

VisibleBuilding visible_building(const RunBuilding& building, PlanEvidence by) {
  const std::vector<bim::Slab> floors = floors_without_edges(building.as_built());
  const Scanned as_planned = scanned(building.as_planned(), building.mesh_as_planned(), floors);
  const bim::BuildingMesh planned = bim::visible_mesh(as_planned.building, as_planned.mesh);
  const IsLeftOut is_left_out = left_out(building, by);
  bim::Building counted = building.as_planned();
  const bool leaves_out = std::erase_if(counted.obstacles, is_left_out) > 0;
  const bim::BuildingMesh seen = leaves_out ? without(is_left_out, as_planned.building, planned) : planned;
  VisibleBuilding visible{visible_scene(seen), std::nullopt, {}, storey_isometries(counted), true};
  for (const bim::MeshElement& element : seen.elements)
    if (element.triangle_count > 0 && !is_assumed(as_planned.building, element)) visible.featureless = false;
  if (!building.deviates() && !leaves_out) return visible;
  const Scanned as_built = scanned(building.as_built(), building.mesh_as_built(), floors);
  visible.built.emplace(visible_scene(bim::visible_mesh(as_built.building, as_built.mesh)));
  visible.loose = loose_elements(building, as_built, by);
  return visible;
}

Floor floor_of(const bim::Building& as_built, std::size_t storey, double step_m) {
  Floor floor;
  floor.storey = storey;
  const SearchArea area = search_area(as_built, storey);
  if (area.empty()) return floor;
  const sim::ClearanceMap space(as_built, static_cast<int>(storey));
  const Rooms rooms(as_built, storey);
  const std::vector<double> ys = area.lines(1, step_m);
  for (const double x : area.lines(0, step_m))
    for (const double y : ys)
      if (space.free({x, y}) && rooms.hold({x, y})) floor.cells_W.emplace_back(x, y);
  floor.links = links_of(floor, surroundings(floor, area, space));
  return floor;
}

}  // namespace plumbline::scenarios
