// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "bim/model/building.h"

namespace plumbline::bim {

/// Signature in the header of a file that write_ifc() made: its version and a digest of the entities, without carriage
/// returns. A file whose entities have changed since is read like any other.
[[nodiscard]] std::string roundtrip_signature(std::string_view entities);

/// True when the text carries the signature of its own entities.
[[nodiscard]] bool has_roundtrip_signature(std::string_view text);

/// Names of enumerations in property sets.
[[nodiscard]] std::string_view name_of(StoreyKind kind);
[[nodiscard]] std::string_view name_of(OpeningKind kind);
[[nodiscard]] std::string_view name_of(Leaf leaf);
[[nodiscard]] std::optional<StoreyKind> storey_kind_of(std::string_view name);
[[nodiscard]] std::optional<OpeningKind> opening_kind_of(std::string_view name);
[[nodiscard]] std::optional<Leaf> leaf_of(std::string_view name);

}  // namespace plumbline::bim
