// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "bim/config/tree.h"
#include "scenarios/shrink/ddmin.h"

namespace plumbline::scenarios {

/// The tree of a building that is a plan, which parts can be taken out of; nothing for IFC, meshes and traffic-editor
/// plans.
[[nodiscard]] std::optional<Tree> plan_tree(const std::string& bytes, const std::string& name);

/// Kinds of elements of a plan, in the order in which they are taken out: keys of its file.
[[nodiscard]] const std::vector<std::string>& kinds_of_parts();
/// Elements of one kind, or of all.
[[nodiscard]] std::size_t parts_in(const Tree& plan, const std::string& kind);
[[nodiscard]] std::size_t parts_in(const Tree& plan);

/// The plan with these elements of a kind only. What stands on a storey or in a wall that goes, goes, too, and so do
/// deviations of what goes; a declared symmetry holds no longer and goes, as do materials that nothing is made of.
[[nodiscard]] Tree with_parts(const Tree& plan, const std::string& kind, const Kept& kept);

/// The text of a plan, checked. Throws InputError.
[[nodiscard]] std::string plan_text(const Tree& plan);

}  // namespace plumbline::scenarios
