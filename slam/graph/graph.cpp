// SPDX-License-Identifier: Apache-2.0
#include "slam/graph/graph.h"

#include "bim/digest/digest.h"

namespace plumbline::slam {

std::uint64_t digest_of(const Graph& graph) {
  Digest digest;
  for (const KeyframeVertex& keyframe : graph.keyframes) digest.add(keyframe.X_MR);
  for (const PlaneVertex& plane : graph.planes) digest.add(plane.plane_M).add(plane.merged_into);
  for (const RoomVertex& room : graph.rooms) digest.add(room.center_M);
  for (const FloorVertex& floor : graph.floors) digest.add(floor.center_M);
  return digest.value();
}

std::vector<LoopEdge> loop_edges(const Graph& graph) {
  std::vector<LoopEdge> edges;
  const auto stamp = [&](int keyframe) { return graph.keyframes[static_cast<std::size_t>(keyframe)].stamp; };
  for (const PoseFactor& factor : graph.pose_factors)
    if (factor.loop) edges.push_back({stamp(factor.from), stamp(factor.to), factor.X_FT});
  return edges;
}

}  // namespace plumbline::slam
