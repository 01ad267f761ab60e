// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/config/tree.h"
#include "slam/graph/graph.h"

namespace plumbline::slam {

/// A graph as a plain tree: `graph: 1`, then a list a kind of vertex and of factor, in order of ids. Poses are [x, y,
/// z, qx, qy, qz, qw], planes [nx, ny, nz, d], information matrices their upper triangles by rows; m, rad, ns.
[[nodiscard]] Tree graph_tree(const Graph& graph);

}  // namespace plumbline::slam
