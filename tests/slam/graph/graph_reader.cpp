// SPDX-License-Identifier: Apache-2.0
#include "tests/slam/graph/graph_reader.h"

#include <Eigen/Cholesky>
#include <array>
#include <cmath>

#include "bim/errors.h"
#include "slam/graph/graph_json.h"

namespace plumbline::slam {

namespace {

constexpr std::array<std::string_view, 3> plane_kinds = {"wall", "floor", "ceiling"};
constexpr std::array<std::string_view, 3> room_kinds = {"four_wall", "two_wall", "polygon"};
constexpr double unit_tolerance = 1e-6;  ///< of a normal's or quaternion's norm; written ones are off by 1e-16

/// Reads the fields of one map and knows how many vertices there are to name.
class Reader {
 public:
  Reader(const Tree& tree, const Graph& graph) : tree_(tree), graph_(graph) {}

  [[nodiscard]] const Tree& child(std::string_view key) const {
    const Tree* found = tree_.find(key);
    if (found == nullptr) throw InputError(tree_.mark, "the key '" + std::string(key) + "' is missing");
    return *found;
  }
  [[nodiscard]] double number(std::string_view key) const { return finite(child(key)); }
  [[nodiscard]] double positive(std::string_view key) const {
    const double value = number(key);
    if (!(value > 0.0)) throw InputError(child(key).mark, "a number above 0 is expected");
    return value;
  }
  [[nodiscard]] int integer(std::string_view key) const { return in_range(child(key), -1, 1'000'000'000); }
  [[nodiscard]] int keyframe(std::string_view key) const { return index(child(key), graph_.keyframes.size()); }
  [[nodiscard]] int plane(std::string_view key) const { return index(child(key), graph_.planes.size()); }
  [[nodiscard]] int room(std::string_view key) const { return index(child(key), graph_.rooms.size()); }
  [[nodiscard]] int floor(std::string_view key) const { return index(child(key), graph_.floors.size()); }
  /// A plane or -1.
  [[nodiscard]] int no_plane_or(std::string_view key, std::size_t count) const {
    return in_range(child(key), -1, static_cast<std::int64_t>(count) - 1);
  }
  [[nodiscard]] std::vector<int> planes(std::string_view key) const {
    std::vector<int> ids;
    for (const Tree& id : child(key).as_list()) ids.push_back(index(id, graph_.planes.size()));
    const bool polygon = tree_.find("corners") != nullptr;
    if (polygon && (ids.size() < 2 || ids.size() > max_room_planes))
      throw InputError(child(key).mark, "2 to " + std::to_string(max_room_planes) + " planes are expected");
    if (!polygon && ids.size() != 2 && ids.size() != 4)
      throw InputError(child(key).mark, "two or four planes are expected");
    return ids;
  }
  /// Of a room of so many planes; empty where there is no such key.
  [[nodiscard]] std::vector<RoomCorner> corners(std::string_view key, std::size_t planes) const {
    std::vector<RoomCorner> corners;
    const Tree* list = tree_.find(key);
    if (list == nullptr) return corners;
    for (const Tree& corner : list->as_list()) {
      const std::vector<Tree>& walls = corner.as_list();
      if (walls.size() != 2) throw InputError(corner.mark, "a corner of two walls is expected");
      corners.push_back({index(walls[0], planes), index(walls[1], planes)});
    }
    if (corners.empty() || corners.size() > max_room_planes)
      throw InputError(list->mark, "1 to " + std::to_string(max_room_planes) + " corners are expected");
    return corners;
  }
  template <std::size_t N>
  [[nodiscard]] int kind(std::string_view key, const std::array<std::string_view, N>& names) const {
    const std::string& name = child(key).as_string();
    for (std::size_t i = 0; i < N; ++i)
      if (names[i] == name) return static_cast<int>(i);
    throw InputError(child(key).mark, "unknown kind '" + name + "'");
  }
  template <int N>
  [[nodiscard]] Eigen::Matrix<double, N, 1> vector(std::string_view key) const {
    const Tree& list = child(key);
    if (list.as_list().size() != N) throw InputError(list.mark, std::to_string(N) + " numbers are expected");
    Eigen::Matrix<double, N, 1> v;
    for (int i = 0; i < N; ++i) v(i) = finite(list.as_list()[static_cast<std::size_t>(i)]);
    return v;
  }
  [[nodiscard]] Pose pose(std::string_view key) const {
    const auto v = vector<7>(key);
    check_unit(v.template tail<4>().norm(), key);
    return {Eigen::Quaterniond(v(6), v(3), v(4), v(5)), v.template head<3>()};
  }
  [[nodiscard]] Plane plane_value(std::string_view key) const {
    const auto v = vector<4>(key);
    check_unit(v.template head<3>().norm(), key);
    return {v.template head<3>(), v(3)};
  }
  template <int N>
  [[nodiscard]] Eigen::Matrix<double, N, N> information(std::string_view key) const {
    const auto v = vector<N*(N + 1) / 2>(key);
    Eigen::Matrix<double, N, N> matrix;
    int i = 0;
    for (int row = 0; row < N; ++row)
      for (int column = row; column < N; ++column) matrix(row, column) = matrix(column, row) = v(i++);
    if (matrix.llt().info() != Eigen::Success)
      throw InputError(child(key).mark, "a positive definite matrix is expected");
    return matrix;
  }

 private:
  static double finite(const Tree& tree) {
    const double value = tree.as_double();
    if (!std::isfinite(value)) throw InputError(tree.mark, "a finite number is expected");
    return value;
  }
  static int in_range(const Tree& tree, std::int64_t low, std::int64_t high) {
    const std::int64_t value = tree.as_int();
    if (value < low || value > high)
      throw InputError(tree.mark, "out of range: " + std::to_string(value) + "; at least " + std::to_string(low) +
                                      " and at most " + std::to_string(high) + " is expected");
    return static_cast<int>(value);
  }
  static int index(const Tree& tree, std::size_t count) {
    return in_range(tree, 0, static_cast<std::int64_t>(count) - 1);
  }
  void check_unit(double norm, std::string_view key) const {
    if (std::abs(norm - 1.0) > unit_tolerance) throw InputError(child(key).mark, "its direction must have length 1");
  }

  const Tree& tree_;
  const Graph& graph_;
};

template <class T, class Read>
void read_list(const Tree& tree, std::string_view key, Graph& graph, std::vector<T>& out, const Read& read) {
  for (const Tree& item : Reader(tree, graph).child(key).as_list()) out.push_back(read(Reader(item, graph)));
}

void read_vertices(const Tree& tree, Graph& graph) {
  const std::size_t planes = Reader(tree, graph).child("planes").as_list().size();
  read_list(tree, "keyframes", graph, graph.keyframes, [](const Reader& r) {
    return KeyframeVertex{r.child("stamp_ns").as_int(), r.pose("X_MR"), r.pose("X_OR"), r.integer("storey")};
  });
  read_list(tree, "planes", graph, graph.planes, [&](const Reader& r) {
    return PlaneVertex{r.plane_value("plane_M"), static_cast<PlaneKind>(r.kind("kind", plane_kinds)),
                       r.integer("storey"), r.no_plane_or("merged_into", planes)};
  });
  read_list(tree, "rooms", graph, graph.rooms, [](const Reader& r) {
    return RoomVertex{static_cast<RoomKind>(r.kind("kind", room_kinds)), r.vector<2>("center_M"), r.integer("storey"),
                      r.child("found").as_bool()};
  });
  read_list(tree, "floors", graph, graph.floors, [&](const Reader& r) {
    return FloorVertex{r.vector<2>("center_M"), r.integer("storey"), r.no_plane_or("plane", planes)};
  });
}

void read_factors(const Tree& tree, Graph& graph) {
  read_list(tree, "pose_factors", graph, graph.pose_factors, [](const Reader& r) {
    return PoseFactor{r.keyframe("from"), r.keyframe("to"), r.pose("X_FT"), r.information<6>("information"),
                      r.child("loop").as_bool()};
  });
  read_list(tree, "plane_factors", graph, graph.plane_factors, [](const Reader& r) {
    return PlaneFactor{r.keyframe("keyframe"), r.plane("plane"), r.plane_value("plane_R"),
                       r.information<3>("information")};
  });
  read_list(tree, "room_factors", graph, graph.room_factors, [](const Reader& r) {
    const std::vector<int> planes = r.planes("planes");
    return RoomFactor{r.room("room"),
                      planes,
                      r.vector<2>("cluster_M"),
                      r.number("height_M"),
                      r.information<2>("information"),
                      r.corners("corners", planes.size())};
  });
  read_list(tree, "floor_factors", graph, graph.floor_factors, [](const Reader& r) {
    return FloorFactor{r.floor("floor"), r.room("room"), r.vector<2>("offset_M"), r.information<2>("information")};
  });
  read_list(tree, "duplicate_factors", graph, graph.duplicate_factors, [](const Reader& r) {
    return DuplicateFactor{r.plane("a"), r.plane("b"), r.vector<3>("anchor_M"), r.positive("angle_sigma"),
                           r.positive("offset_sigma")};
  });
}

}  // namespace

Graph read_graph(const Tree& tree) {
  Graph graph;
  if (Reader(tree, graph).child("graph").as_int() != 1)
    throw InputError(Reader(tree, graph).child("graph").mark, "graph: 1 is expected");
  read_vertices(tree, graph);
  read_factors(tree, graph);
  return graph;
}

std::string write_graph_json(const Graph& graph) { return write_json(graph_tree(graph), 0) + "\n"; }

Graph read_graph_json(std::string_view text, const std::string& file) { return read_graph(read_json(text, file)); }

}  // namespace plumbline::slam
