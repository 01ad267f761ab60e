// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "bim/model/building.h"

namespace plumbline::bim {

/// What the header of a file says that write_ifc() made: the version of what it writes and a digest of the entities,
/// carriage returns left out. A file whose entities were changed since is read like any other.
[[nodiscard]] std::string written_mark(std::string_view entities);

/// True when the text carries the mark of just its entities.
[[nodiscard]] bool has_written_mark(std::string_view text);

/// The words in which property sets give enumerations.
[[nodiscard]] std::string_view name_of(StoreyKind kind);
[[nodiscard]] std::string_view name_of(OpeningKind kind);
[[nodiscard]] std::string_view name_of(Leaf leaf);
[[nodiscard]] std::optional<StoreyKind> storey_kind_of(std::string_view name);
[[nodiscard]] std::optional<OpeningKind> opening_kind_of(std::string_view name);
[[nodiscard]] std::optional<Leaf> leaf_of(std::string_view name);

}  // namespace plumbline::bim
