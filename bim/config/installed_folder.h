// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string>

namespace plumbline {

/// A folder that comes with the program: the first of these that holds the file. The paths start at the program's own
/// folder; empty where none does.
[[nodiscard]] std::string installed_folder(std::initializer_list<const char*> from_program, const char* file);

}  // namespace plumbline
