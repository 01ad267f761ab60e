// SPDX-License-Identifier: Apache-2.0
#include "scenarios/run/estimate_file.h"

#include <array>
#include <cmath>
#include <limits>

#include "bim/config/number_list.h"
#include "scenarios/metrics/state_names.h"
#include "scenarios/run/as_written.h"
#include "slam/io/second.h"

namespace plumbline::scenarios {

namespace {

constexpr auto room_names = names_of(slam::RoomKind{});

const Tree& child(const Tree& tree, std::string_view key) {
  const Tree* found = tree.find(key);
  if (found == nullptr) throw InputError(tree.mark, "the key '" + std::string(key) + "' is missing");
  return *found;
}

constexpr double most_length_m = 1e8;  // as of a pose

double read_number(const Tree& tree, double most = most_length_m) {
  const double value = tree.as_double();
  if (!(std::abs(value) <= most))
    throw InputError(tree.mark, "a number of at most " + format_number(most) + " is expected");
  return value;
}

template <std::size_t N>
std::array<double, N> read_numbers(const Tree& tree, double most = most_length_m) {
  const Tree::List& list = tree.as_list();
  if (list.size() != N) throw InputError(tree.mark, std::to_string(N) + " numbers are expected");
  std::array<double, N> values{};
  for (std::size_t i = 0; i < N; ++i) values[i] = read_number(list[i], most);
  return values;
}

int read_int(const Tree& tree, int least = std::numeric_limits<int>::min(),
             int most = std::numeric_limits<int>::max()) {
  const std::int64_t value = tree.as_int();
  if (value < least || value > most)
    throw InputError(tree.mark,
                     "a whole number from " + std::to_string(least) + " to " + std::to_string(most) + " is expected");
  return static_cast<int>(value);
}

Eigen::Vector2d read_2d(const Tree& tree) {
  const auto v = read_numbers<2>(tree);
  return {v[0], v[1]};
}
Eigen::Vector3d read_3d(const Tree& tree) {
  const auto v = read_numbers<3>(tree);
  return {v[0], v[1], v[2]};
}
Pose read_pose(const Tree& tree) {
  const auto v = read_numbers<7>(tree);
  return {Eigen::Quaterniond(v[6], v[3], v[4], v[5]), {v[0], v[1], v[2]}};
}
slam::Nanoseconds read_stamp(const Tree& tree) {
  const slam::Nanoseconds stamp = tree.as_int();
  if (stamp <= -slam::furthest_stamp || stamp >= slam::furthest_stamp)
    throw InputError(tree.mark, "a time of less than 4e18 ns is expected");
  return stamp;
}

template <std::size_t N>
int index_of(const Tree& tree, const std::array<std::string_view, N>& names) {
  for (std::size_t i = 0; i < N; ++i)
    if (names[i] == tree.as_string()) return static_cast<int>(i);
  throw InputError(tree.mark, "unknown name '" + tree.as_string() + "'");
}

Tree write(const slam::PlaneNode& plane) {
  Tree tree = Tree::map();
  tree.set("id", plane.id).set("n", number_list(plane.plane_F.n)).set("d", plane.plane_F.d);
  tree.set("p0", number_list(plane.p0)).set("p1", number_list(plane.p1)).set("z0", plane.z0).set("z1", plane.z1);
  return tree.set("observations", plane.observations);
}

slam::PlaneNode read_plane(const Tree& tree) {
  slam::PlaneNode plane;
  plane.id = read_int(child(tree, "id"));
  plane.plane_F = {read_3d(child(tree, "n")), read_number(child(tree, "d"))};
  plane.p0 = read_2d(child(tree, "p0"));
  plane.p1 = read_2d(child(tree, "p1"));
  plane.z0 = read_number(child(tree, "z0"));
  plane.z1 = read_number(child(tree, "z1"));
  plane.observations = read_int(child(tree, "observations"));
  return plane;
}

Tree write(const slam::RoomNode& room) {
  Tree polygon = Tree::list();
  for (const Eigen::Vector2d& p : room.polygon_F) polygon.push(number_list(p));
  Tree planes = Tree::list();
  for (const int id : room.planes) planes.push(id);
  Tree tree = Tree::map();
  tree.set("id", room.id).set("kind", room_names[static_cast<std::size_t>(room.kind)]);
  return tree.set("center", number_list(room.center_F)).set("polygon", polygon).set("planes", planes);
}

slam::RoomNode read_room(const Tree& tree) {
  slam::RoomNode room;
  room.id = read_int(child(tree, "id"));
  room.kind = static_cast<slam::RoomKind>(index_of(child(tree, "kind"), room_names));
  room.center_F = read_2d(child(tree, "center"));
  for (const Tree& p : child(tree, "polygon").as_list()) room.polygon_F.push_back(read_2d(p));
  for (const Tree& id : child(tree, "planes").as_list()) room.planes.push_back(read_int(id));
  return room;
}

Tree write(const slam::FloorNode& floor) {
  Tree tree = Tree::map();
  tree.set("id", floor.id).set("center", number_list(floor.center_F));
  return tree.set("n", number_list(floor.plane_F.n)).set("d", floor.plane_F.d);
}

slam::FloorNode read_floor(const Tree& tree) {
  return {read_int(child(tree, "id")),
          read_3d(child(tree, "center")),
          {read_3d(child(tree, "n")), read_number(child(tree, "d"))}};
}

Tree write(const slam::LoopEdge& loop) {
  return Tree::map().set("from_ns", loop.from).set("to_ns", loop.to).set("pose", number_list(loop.X_FT));
}

slam::LoopEdge read_loop(const Tree& tree) {
  return {read_stamp(child(tree, "from_ns")), read_stamp(child(tree, "to_ns")), read_pose(child(tree, "pose"))};
}

/// One list of x, y, z, plane, x, ...
Tree write(const slam::SegmentedScan& scan) {
  Tree values = Tree::list();
  for (std::size_t i = 0; i < scan.point_mm.size(); ++i) {
    for (const int mm : scan.point_mm[i]) values.push(mm);
    values.push(scan.plane[i]);
  }
  return Tree::map().set("stamp_ns", scan.stamp).set("sensor", number_list(scan.sensor_R)).set("xyz_mm_plane", values);
}

slam::SegmentedScan read_segmented(const Tree& tree) {
  slam::SegmentedScan scan{read_stamp(child(tree, "stamp_ns")), read_3d(child(tree, "sensor")), {}, {}};
  const Tree& values = child(tree, "xyz_mm_plane");
  const Tree::List& list = values.as_list();
  if (list.size() % 4 != 0) throw InputError(values.mark, "four numbers a point are expected");
  constexpr int most = 1'000'000;
  const auto at = [&](std::size_t k) { return read_int(list[k], -most, most); };
  for (std::size_t i = 0; i < list.size(); i += 4) {
    scan.point_mm.emplace_back(at(i), at(i + 1), at(i + 2));
    scan.plane.push_back(at(i + 3));
  }
  return scan;
}

Tree write(const slam::WallMatch& match) {
  Tree faces = Tree::list();
  for (const int face : match.faces) faces.push(face);
  return Tree::map()
      .set("faces", faces)
      .set("p0", number_list(rounded(match.p0_R)))
      .set("p1", number_list(rounded(match.p1_R)));
}

slam::WallMatch read_match(const Tree& tree) {
  slam::WallMatch match{{}, read_3d(child(tree, "p0")), read_3d(child(tree, "p1"))};
  for (const Tree& face : child(tree, "faces").as_list()) match.faces.push_back(read_int(face));
  return match;
}

Tree write(const slam::Hypothesis& hypothesis) {
  Tree covariance = Tree::list();
  for (int row = 0; row < 3; ++row)
    for (int col = 0; col < 3; ++col) covariance.push(hypothesis.covariance(row, col));
  Tree tree = Tree::map();
  tree.set("mass", hypothesis.mass).set("room", hypothesis.room);
  tree.set("pose", number_list(hypothesis.X_WR)).set("covariance", covariance);
  if (hypothesis.walls.empty()) return tree;
  Tree walls = Tree::list();
  for (const slam::WallMatch& match : hypothesis.walls) walls.push(write(match));
  return tree.set("walls", walls);
}

Tree write(const slam::Particle& particle) {
  const slam::Particle p = rounded(particle);
  return number_list({p.x, p.y, p.yaw, p.weight});
}

Tree write(const score::LostSpan& span) { return Tree::list().push(span.from).push(span.to); }

/// In time order, as score_silence wants them.
std::vector<score::LostSpan> read_spans(const Tree& tree) {
  std::vector<score::LostSpan> spans;
  for (const Tree& entry : tree.as_list()) {
    const Tree::List& ends = entry.as_list();
    if (ends.size() != 2) throw InputError(entry.mark, "2 numbers are expected");
    const score::LostSpan span{read_stamp(ends[0]), read_stamp(ends[1])};
    if (span.to < span.from || (!spans.empty() && span.from < spans.back().to))
      throw InputError(entry.mark, "times must be in order");
    spans.push_back(span);
  }
  return spans;
}

template <class T>
Tree write_list(const std::vector<T>& values) {
  Tree list = Tree::list();
  for (const T& value : values) list.push(write(value));
  return list;
}

slam::Hypothesis read_hypothesis(const Tree& tree) {
  slam::Hypothesis hypothesis;
  hypothesis.mass = read_number(child(tree, "mass"));
  hypothesis.room = child(tree, "room").as_string();
  hypothesis.X_WR = read_pose(child(tree, "pose"));
  const auto c = read_numbers<9>(child(tree, "covariance"), most_length_m * most_length_m);
  for (int row = 0; row < 3; ++row)
    for (int col = 0; col < 3; ++col) hypothesis.covariance(row, col) = c[static_cast<std::size_t>(3 * row + col)];
  if (const Tree* walls = tree.find("walls"))
    for (const Tree& match : walls->as_list()) hypothesis.walls.push_back(read_match(match));
  return hypothesis;
}

BeliefRecord read_belief(const Tree& tree) {
  BeliefRecord belief;
  belief.stamp = read_stamp(child(tree, "stamp_ns"));
  belief.state = static_cast<slam::State>(index_of(child(tree, "state"), state_names));
  for (const Tree& h : child(tree, "hypotheses").as_list()) belief.hypotheses.push_back(read_hypothesis(h));
  if (const Tree* particles = tree.find("particles"))
    for (const Tree& p : particles->as_list()) {
      const auto v = read_numbers<4>(p);
      belief.particles.push_back({v[0], v[1], v[2], v[3]});
    }
  return belief;
}

}  // namespace

std::string write_estimate(const MethodRecord& method) {
  Tree tree = Tree::map();
  tree.set("method", method.name);
  tree.set("frame", method.estimate.frame == slam::Frame::world ? "world" : "map");
  tree.set("scored_as", method.localization ? "localization" : "slam");
  if (method.crashed) tree.set("crashed", method.error);
  if (method.shift != 0) tree.set("shift_ns", method.shift);
  if (method.scans > 0)
    tree.set("scans", method.scans)
        .set("lost_scans", method.lost_scans)
        .set("degenerate_scans", method.degenerate_scans)
        .set("lost_ns", write_list(method.lost));
  tree.set("planes", write_list(method.estimate.planes));
  tree.set("rooms", write_list(method.estimate.rooms));
  tree.set("floors", write_list(method.estimate.floors));
  if (method.estimate.loops) tree.set("loops", write_list(*method.estimate.loops));
  if (!method.estimate.segmented.empty()) tree.set("segmented", write_list(method.estimate.segmented));
  if (!method.gates.empty()) {
    Tree gates = Tree::list();
    for (const GateSpec& gate : method.gates) gates.push(to_tree(gate));
    tree.set("gates", std::move(gates));
  }
  return write_json(tree) + "\n";
}

void read_estimate(std::string_view text, const std::string& file, MethodRecord& method) {
  const Tree tree = read_json(text, file);
  method.name = child(tree, "method").as_string();
  method.estimate.frame = child(tree, "frame").as_string() == "world" ? slam::Frame::world : slam::Frame::map;
  method.localization = child(tree, "scored_as").as_string() == "localization";
  if (const Tree* error = tree.find("crashed")) {
    method.crashed = true;
    method.error = error->as_string();
  }
  if (const Tree* shift = tree.find("shift_ns")) method.shift = read_stamp(*shift);
  if (const Tree* scans = tree.find("scans")) {
    method.scans = read_int(*scans, 0);
    method.lost_scans = read_int(child(tree, "lost_scans"), 0);
    method.degenerate_scans = read_int(child(tree, "degenerate_scans"), 0);
    method.lost = read_spans(child(tree, "lost_ns"));
  }
  for (const Tree& plane : child(tree, "planes").as_list()) method.estimate.planes.push_back(read_plane(plane));
  for (const Tree& room : child(tree, "rooms").as_list()) method.estimate.rooms.push_back(read_room(room));
  for (const Tree& floor : child(tree, "floors").as_list()) method.estimate.floors.push_back(read_floor(floor));
  if (const Tree* loops = tree.find("loops")) {
    method.estimate.loops.emplace();
    for (const Tree& loop : loops->as_list()) method.estimate.loops->push_back(read_loop(loop));
  }
  if (const Tree* segmented = tree.find("segmented"))
    for (const Tree& scan : segmented->as_list()) method.estimate.segmented.push_back(read_segmented(scan));
  if (const Tree* gates = tree.find("gates"))
    for (const Tree& gate : gates->as_list()) {
      method.gates.push_back(from_tree<GateSpec>(gate));
      check_gate(method.gates.back(), gate);
    }
}

std::string write_beliefs(const std::vector<BeliefRecord>& beliefs) {
  std::string text;
  for (const BeliefRecord& belief : beliefs) {
    Tree tree = Tree::map();
    tree.set("stamp_ns", belief.stamp).set("state", state_name(belief.state));
    tree.set("hypotheses", write_list(belief.hypotheses));
    if (!belief.particles.empty()) tree.set("particles", write_list(belief.particles));
    text += write_json(tree, 0) + "\n";
  }
  return text;
}

std::vector<BeliefRecord> read_beliefs(std::string_view text, const std::string& file) {
  std::vector<BeliefRecord> beliefs;
  int line = 0;
  while (!text.empty()) {
    ++line;
    const std::size_t end = std::min(text.find('\n'), text.size());
    Tree tree;
    try {
      tree = read_json(text.substr(0, end), file);
      beliefs.push_back(read_belief(tree));
    } catch (const InputError&) {
      throw InputError({file, line, 1}, "the line must be a belief: {stamp_ns, state, hypotheses}");
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return beliefs;
}

}  // namespace plumbline::scenarios
