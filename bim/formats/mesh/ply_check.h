// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace plumbline::bim {

/// Compares the header of a .ply file with its size, before a reader that believes the header sees it: the header ends,
/// each line is of the format [turk1994], and as many bytes follow as its elements take at least. Throws InputError at
/// the line that is wrong.
void check_ply(std::string_view bytes, const std::string& path);

}  // namespace plumbline::bim
