// SPDX-License-Identifier: Apache-2.0
#include "slam/graph/graph_json.h"

#include <array>

#include "bim/config/number_list.h"

namespace plumbline::slam {

namespace {

constexpr std::array<std::string_view, 3> plane_kinds = {"wall", "floor", "ceiling"};
constexpr auto room_kinds = names_of(RoomKind{});

template <int N>
Tree write_information(const Eigen::Matrix<double, N, N>& matrix) {
  Tree list = Tree::list();
  for (int row = 0; row < N; ++row)
    for (int column = row; column < N; ++column) list.push(matrix(row, column));
  return list;
}

Tree write(const KeyframeVertex& v) {
  Tree tree = Tree::map();
  tree.set("stamp_ns", v.stamp).set("X_MR", number_list(v.X_MR)).set("X_OR", number_list(v.X_OR));
  return tree.set("storey", v.storey);
}
Tree write(const PlaneVertex& v) {
  Tree tree = Tree::map();
  tree.set("kind", plane_kinds.at(static_cast<std::size_t>(v.kind))).set("plane_M", number_list(v.plane_M));
  return tree.set("storey", v.storey).set("merged_into", v.merged_into);
}
Tree write(const RoomVertex& v) {
  Tree tree = Tree::map();
  tree.set("kind", room_kinds.at(static_cast<std::size_t>(v.kind))).set("center_M", number_list(v.center_M));
  return tree.set("storey", v.storey).set("found", v.found);
}
Tree write(const FloorVertex& v) {
  Tree tree = Tree::map();
  return tree.set("center_M", number_list(v.center_M)).set("storey", v.storey).set("plane", v.plane);
}
Tree write(const PoseFactor& f) {
  Tree tree = Tree::map();
  tree.set("from", f.from).set("to", f.to).set("X_FT", number_list(f.X_FT));
  return tree.set("information", write_information(f.information)).set("loop", f.loop);
}
Tree write(const PlaneFactor& f) {
  Tree tree = Tree::map();
  tree.set("keyframe", f.keyframe).set("plane", f.plane).set("plane_R", number_list(f.plane_R));
  return tree.set("information", write_information(f.information));
}
Tree write(const RoomFactor& f) {
  Tree planes = Tree::list();
  for (const int id : f.planes) planes.push(id);
  Tree tree = Tree::map();
  tree.set("room", f.room).set("planes", planes);
  if (!f.corners.empty()) {
    Tree corners = Tree::list();
    for (const auto& [a, b] : f.corners) corners.push(Tree::list().push(a).push(b));
    tree.set("corners", corners);
  }
  tree.set("cluster_M", number_list(f.cluster_M)).set("height_M", f.height_M);
  return tree.set("information", write_information(f.information));
}
Tree write(const FloorFactor& f) {
  Tree tree = Tree::map();
  tree.set("floor", f.floor).set("room", f.room).set("offset_M", number_list(f.offset_M));
  return tree.set("information", write_information(f.information));
}
Tree write(const DuplicateFactor& f) {
  Tree tree = Tree::map();
  tree.set("a", f.a).set("b", f.b).set("anchor_M", number_list(f.anchor_M));
  return tree.set("angle_sigma", f.angle_sigma).set("offset_sigma", f.offset_sigma);
}

template <class T>
Tree write_list(const std::vector<T>& values) {
  Tree list = Tree::list();
  for (const T& value : values) list.push(write(value));
  return list;
}

}  // namespace

Tree graph_tree(const Graph& graph) {
  Tree tree = Tree::map();
  tree.set("graph", 1);
  tree.set("keyframes", write_list(graph.keyframes)).set("planes", write_list(graph.planes));
  tree.set("rooms", write_list(graph.rooms)).set("floors", write_list(graph.floors));
  tree.set("pose_factors", write_list(graph.pose_factors)).set("plane_factors", write_list(graph.plane_factors));
  tree.set("room_factors", write_list(graph.room_factors)).set("floor_factors", write_list(graph.floor_factors));
  return tree.set("duplicate_factors", write_list(graph.duplicate_factors));
}

}  // namespace plumbline::slam
