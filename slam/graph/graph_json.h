// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "bim/config/tree.h"
#include "slam/graph/graph.h"

namespace plumbline::slam {

/// A graph as a plain tree: `graph: 1`, then a list a kind of vertex and of factor, in order of ids. Poses are [x, y,
/// z, qx, qy, qz, qw], planes [nx, ny, nz, d], information matrices their upper triangles by rows; m, rad, ns.
[[nodiscard]] Tree graph_tree(const Graph& graph);
/// The graph that gives this tree back to the last bit, zeros' signs apart. Throws InputError at the value that is
/// missing, not finite, out of range, or that names a vertex there is not.
[[nodiscard]] Graph read_graph(const Tree& tree);

/// The same as JSON text.
[[nodiscard]] std::string write_graph_json(const Graph& graph);
[[nodiscard]] Graph read_graph_json(std::string_view text, const std::string& file);

}  // namespace plumbline::slam
