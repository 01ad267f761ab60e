// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace plumbline::slam {

/// Where the clients for methods that are processes lie: installed beside this program, or in the tree that it was
/// built in. Empty where they are in neither.
[[nodiscard]] std::string client_folder();

}  // namespace plumbline::slam
