// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/estimate/plan_drawing.h"

#include <cmath>
#include <initializer_list>
#include <string>
#include <utility>

#include "bim/config/tree.h"
#include "bim/errors.h"

namespace plumbline::scenarios {

namespace {

constexpr std::size_t face_numbers = 6, hole_numbers = 4;  // ends, bottom and top; as bim::FaceHole

double to_mm(double metres) { return std::round(1000.0 * metres) / 1000.0; }

Tree numbers_of(std::initializer_list<double> values) {
  Tree list = Tree::list();
  for (const double value : values) list.push(to_mm(value));
  return list;
}

Tree outline_of(const Polygon2& polygon) {
  Tree list = Tree::list();
  for (const Eigen::Vector2d& p : polygon) list.push(to_mm(p.x())).push(to_mm(p.y()));
  return list;
}

const Tree& part_of(const Tree& tree, std::string_view key) {
  const Tree* part = tree.is_map() ? tree.find(key) : nullptr;
  if (part == nullptr) throw InputError(tree.mark, "'" + std::string(key) + "' is missing");
  return *part;
}

/// `count` numbers, or with 0 any even number of them.
std::vector<double> numbers_in(const Tree& tree, std::size_t count) {
  std::vector<double> values;
  for (const Tree& value : tree.as_list()) {
    values.push_back(value.as_double());
    constexpr double most_m = 1e7;
    if (!(std::abs(values.back()) <= most_m)) throw InputError(value.mark, "a length in m is expected");
  }
  if (count > 0 ? values.size() != count : values.size() % 2 != 0)
    throw InputError(tree.mark, count > 0 ? std::to_string(count) + " numbers are expected" : "x and y are expected");
  return values;
}

Polygon2 polygon_in(const Tree& tree) {
  const std::vector<double> values = numbers_in(tree, 0);
  Polygon2 polygon;
  for (std::size_t i = 0; i < values.size(); i += 2) polygon.emplace_back(values[i], values[i + 1]);
  return polygon;
}

/// An index of a storey, or -1.
int storey_in(const Tree& tree, std::size_t storeys, std::string_view key = "storey") {
  const Tree& value = part_of(tree, key);
  const std::int64_t index = value.as_int();
  if (index < -1 || index >= static_cast<std::int64_t>(storeys))
    throw InputError(value.mark, "there is no such storey");
  return static_cast<int>(index);
}

Tree face_tree(const bim::PlanFace& face) {
  Tree holes = Tree::list();
  for (const bim::FaceHole& hole : face.holes) holes.push(numbers_of({hole.s0, hole.s1, hole.z0, hole.z1}));
  Tree tree = Tree::map();
  tree.set("id", face.id).set("storey", face.storey);
  tree.set("at", numbers_of({face.p0.x(), face.p0.y(), face.p1.x(), face.p1.y(), face.z0, face.z1}));
  return face.holes.empty() ? tree : tree.set("openings", std::move(holes));
}

bim::PlanFace face_in(const Tree& tree, std::size_t storeys) {
  bim::PlanFace face;
  face.id = static_cast<int>(part_of(tree, "id").as_int());
  face.storey = storey_in(tree, storeys);
  const std::vector<double> at = numbers_in(part_of(tree, "at"), face_numbers);
  face.p0 = {at[0], at[1]};
  face.p1 = {at[2], at[3]};
  face.z0 = at[4];
  face.z1 = at[5];
  if (const Tree* holes = tree.find("openings"))
    for (const Tree& hole : holes->as_list()) {
      const std::vector<double> v = numbers_in(hole, hole_numbers);
      face.holes.push_back({v[0], v[1], v[2], v[3]});
    }
  return face;
}

Tree flight_tree(const ReportFlight& flight) {
  Tree risers = Tree::list();
  for (const auto& [a, b] : flight.risers_W) risers.push(numbers_of({a.x(), a.y(), b.x(), b.y()}));
  return Tree::map().set("from", flight.from).set("to", flight.to).set("risers", std::move(risers));
}

ReportFlight flight_in(const Tree& tree, std::size_t storeys) {
  ReportFlight flight{storey_in(tree, storeys, "from"), storey_in(tree, storeys, "to"), {}};
  for (const Tree& riser : part_of(tree, "risers").as_list()) {
    const std::vector<double> v = numbers_in(riser, hole_numbers);
    flight.risers_W.emplace_back(Eigen::Vector2d(v[0], v[1]), Eigen::Vector2d(v[2], v[3]));
  }
  return flight;
}

}  // namespace

PlanDrawing plan_drawing(const bim::Building& as_planned, const bim::Plan& told) {
  PlanDrawing drawing;
  drawing.plan.storeys = told.storeys;
  for (std::size_t i = 0; i < told.storeys.size() && i < as_planned.storeys.size(); ++i)
    if (!as_planned.storeys[i].name.empty()) drawing.plan.storeys[i].name = as_planned.storeys[i].name;
  drawing.plan.faces = told.faces;
  drawing.plan.rooms = told.rooms;
  drawing.flights = flights_of(as_planned);
  if (!told.furniture.triangles.empty()) {
    drawing.obstacles = obstacles_of(as_planned, told);
    return drawing;
  }
  bim::Building bare;
  bare.storeys = as_planned.storeys;
  bare.columns = as_planned.columns;
  drawing.obstacles = obstacles_of(bare, told);
  return drawing;
}

std::string write_plan_drawing(const PlanDrawing& drawing) {
  Tree storeys = Tree::list(), faces = Tree::list(), rooms = Tree::list(), obstacles = Tree::list(),
       flights = Tree::list();
  for (const bim::PlanStorey& storey : drawing.plan.storeys)
    storeys.push(Tree::map().set("name", storey.name).set("elevation_m", to_mm(storey.elevation_m)));
  for (const bim::PlanFace& face : drawing.plan.faces) faces.push(face_tree(face));
  for (const bim::PlanRoom& room : drawing.plan.rooms)
    rooms.push(Tree::map().set("name", room.name).set("storey", room.storey).set("outline", outline_of(room.polygon)));
  for (const ReportObstacle& obstacle : drawing.obstacles)
    obstacles.push(Tree::map()
                       .set("id", obstacle.id)
                       .set("storey", obstacle.storey)
                       .set("filled", obstacle.filled)
                       .set("outline", outline_of(obstacle.outline_W)));
  for (const ReportFlight& flight : drawing.flights) flights.push(flight_tree(flight));
  Tree tree = Tree::map();
  tree.set("storeys", std::move(storeys)).set("faces", std::move(faces)).set("rooms", std::move(rooms));
  tree.set("obstacles", std::move(obstacles)).set("flights", std::move(flights));
  return write_json(tree, 0) + "\n";
}

PlanDrawing read_plan_drawing(std::string_view text, const std::string& file) {
  const Tree tree = read_json(text, file);
  PlanDrawing drawing;
  bim::Plan& plan = drawing.plan;
  for (const Tree& storey : part_of(tree, "storeys").as_list()) {
    bim::PlanStorey& read = plan.storeys.emplace_back();
    read.name = part_of(storey, "name").as_string();
    read.elevation_m = part_of(storey, "elevation_m").as_double();
  }
  const std::size_t storeys = plan.storeys.size();
  if (storeys == 0) throw InputError({file, 0, 0}, "has no storey");
  for (const Tree& face : part_of(tree, "faces").as_list()) plan.faces.push_back(face_in(face, storeys));
  for (const Tree& room : part_of(tree, "rooms").as_list()) {
    bim::PlanRoom& read = plan.rooms.emplace_back();
    read.name = part_of(room, "name").as_string();
    read.storey = storey_in(room, storeys);
    read.polygon = polygon_in(part_of(room, "outline"));
  }
  for (const Tree& obstacle : part_of(tree, "obstacles").as_list())
    drawing.obstacles.push_back({part_of(obstacle, "id").as_string(), storey_in(obstacle, storeys),
                                 polygon_in(part_of(obstacle, "outline")), part_of(obstacle, "filled").as_bool()});
  for (const Tree& flight : part_of(tree, "flights").as_list()) drawing.flights.push_back(flight_in(flight, storeys));
  return drawing;
}

}  // namespace plumbline::scenarios
