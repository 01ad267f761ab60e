// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace plumbline::bim {

/// Throws InputError for a file that people have of buildings and that is none which is read: an archive, ifcXML, IFC
/// as JSON, text in UTF-16, a project of a CAD program, a pointer of Git LFS. The error says what it is and what to do.
void refuse_foreign_file(std::string_view bytes, const std::string& path);

}  // namespace plumbline::bim
