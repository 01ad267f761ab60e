// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace plumbline::slam {

/// The text in UTF-8; of one with more than `most` characters the first of them, and how many there are.
[[nodiscard]] std::string shortened(const std::string& text, std::size_t most);

}  // namespace plumbline::slam
