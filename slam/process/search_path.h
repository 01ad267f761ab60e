// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace plumbline::slam {

/// The folders of PATH in its order, those of a shell where it is not set. here: what an empty one of them stands for.
[[nodiscard]] std::vector<std::string> search_path(const std::string& here);

}  // namespace plumbline::slam
