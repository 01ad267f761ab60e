// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bim/config/tree.h"

namespace plumbline::scenarios {

/// Value of a key below nested maps, "prior.yaw"; nullptr where there is none.
[[nodiscard]] const Tree* find_at(const Tree& tree, const std::string& key);
/// Sets it; maps on the way are made where they are missing.
void set_at(Tree& tree, const std::string& key, const Tree& value);
/// Removes it, where it is there.
void erase_at(Tree& tree, const std::string& key);

}  // namespace plumbline::scenarios
