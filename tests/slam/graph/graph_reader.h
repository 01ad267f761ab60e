// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "bim/config/tree.h"
#include "slam/graph/graph.h"

namespace plumbline::slam {

/// The graph that gives this tree back to the last bit, zeros' signs apart. Throws InputError at the value that is
/// missing, not finite, out of range, or that names a vertex there is not.
[[nodiscard]] Graph read_graph(const Tree& tree);

/// graph_tree() as JSON text, and back.
[[nodiscard]] std::string write_graph_json(const Graph& graph);
[[nodiscard]] Graph read_graph_json(std::string_view text, const std::string& file);

}  // namespace plumbline::slam
