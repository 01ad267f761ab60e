// SPDX-License-Identifier: Apache-2.0
#include "slam/graph/terms.h"

#include <ceres/cost_function.h>

#include <algorithm>
#include <utility>

#include "slam/graph/cost_functions.h"
#include "slam/graph/factors.h"

namespace plumbline::slam {

namespace {

template <class T>
const T& at(const std::vector<T>& list, int id) {
  return list[static_cast<std::size_t>(id)];
}

template <std::size_t N>
Block padded(const std::array<double, N>& numbers) {
  Block block{};
  std::copy(numbers.begin(), numbers.end(), block.begin());
  return block;
}

Block padded(const Eigen::Vector2d& center) { return padded(CenterBlock{center.x(), center.y()}); }

VertexId keyframe(int id) { return {Layer::keyframe, id}; }
VertexId plane(int id) { return {Layer::plane, id}; }
VertexId room(int id) { return {Layer::room, id}; }

std::vector<VertexId> vertices_of(const RoomFactor& factor) {
  std::vector<VertexId> vertices = {room(factor.room)};
  for (const int id : factor.planes) vertices.push_back(plane(id));
  return vertices;
}

}  // namespace

int tangent_size(Layer layer) {
  switch (layer) {
    case Layer::keyframe:
      return 6;
    case Layer::plane:
      return 3;
    case Layer::room:
    case Layer::floor:
      return 2;
  }
  return 0;
}

Block block_of(const Graph& graph, VertexId vertex) {
  switch (vertex.layer) {
    case Layer::keyframe:
      return padded(to_block(at(graph.keyframes, vertex.id).X_MR));
    case Layer::plane:
      return padded(to_block(at(graph.planes, vertex.id).plane_M));
    case Layer::room:
      return padded(at(graph.rooms, vertex.id).center_M);
    case Layer::floor:
      return padded(at(graph.floors, vertex.id).center_M);
  }
  return {};
}

void write_back(VertexId vertex, const Block& block, Graph& graph) {
  const auto id = static_cast<std::size_t>(vertex.id);
  switch (vertex.layer) {
    case Layer::keyframe:
      graph.keyframes[id].X_MR = to_pose(block.data());
      return;
    case Layer::plane:
      graph.planes[id].plane_M = to_plane(block.data());
      return;
    case Layer::room:
      graph.rooms[id].center_M = {block[0], block[1]};
      return;
    case Layer::floor:
      graph.floors[id].center_M = {block[0], block[1]};
      return;
  }
}

void move(Layer layer, Block& block, const double* step) {
  switch (layer) {
    case Layer::keyframe:
      block = padded(to_block(increment(to_pose(block.data()), Eigen::Map<const Vector6d>(step))));
      return;
    case Layer::plane:
      block = padded(to_block(increment(to_plane(block.data()), Eigen::Map<const Eigen::Vector3d>(step))));
      return;
    case Layer::room:
    case Layer::floor:
      block[0] += step[0];
      block[1] += step[1];
      return;
  }
}

Term::Term(std::unique_ptr<ceres::CostFunction> cost_function, std::vector<VertexId> of, double huber_sigmas)
    : cost(std::move(cost_function)), vertices(std::move(of)), huber(huber_sigmas) {}
Term::~Term() = default;
Term::Term(Term&&) noexcept = default;
Term& Term::operator=(Term&&) noexcept = default;

std::vector<Term> make_terms(const Graph& graph, const FactorSelection& selection, const OptimizerConfig& config) {
  std::vector<Term> terms;
  const auto add = [&](ceres::CostFunction* cost, std::vector<VertexId> vertices, double huber) {
    terms.emplace_back(std::unique_ptr<ceres::CostFunction>(cost), std::move(vertices), huber);
  };
  for (const std::size_t i : selection.pose) {
    const PoseFactor& f = graph.pose_factors[i];
    add(pose_cost(f), {keyframe(f.from), keyframe(f.to)}, f.loop ? config.loop_huber : 0.0);
  }
  for (const std::size_t i : selection.plane) {
    const PlaneFactor& f = graph.plane_factors[i];
    add(plane_cost(f), {keyframe(f.keyframe), plane(f.plane)}, config.huber);
  }
  for (const std::size_t i : selection.room) {
    const RoomFactor& f = graph.room_factors[i];
    add(room_cost(f), vertices_of(f), config.huber);
  }
  for (const std::size_t i : selection.floor) {
    const FloorFactor& f = graph.floor_factors[i];
    add(floor_cost(f), {{Layer::floor, f.floor}, room(f.room)}, 0.0);
  }
  for (const std::size_t i : selection.duplicate) {
    const DuplicateFactor& f = graph.duplicate_factors[i];
    add(duplicate_cost(f), {plane(f.a), plane(f.b)}, config.huber);
  }
  return terms;
}

void add_values(const Graph& graph, const std::vector<Term>& terms, Values& values) {
  for (const Term& term : terms)
    for (const VertexId vertex : term.vertices)
      if (!values.contains(vertex)) values.emplace(vertex, block_of(graph, vertex));
}

}  // namespace plumbline::slam
