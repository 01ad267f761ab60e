// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/config/visit.h"

namespace plumbline::bim {

enum class Doors { as_designed, open, closed };
[[nodiscard]] constexpr std::array<std::string_view, 3> names_of(Doors) { return {"as_designed", "open", "closed"}; }

/// Options of a scenario that change a building without touching its file.
struct BuildingOptions {
  Doors doors = Doors::as_designed;
  bool furniture = true;

  template <class V>
  void visit(V& v);
};

template <class V>
void BuildingOptions::visit(V& v) {
  v("doors", doors, Field{.doc = "state of every door leaf"});
  v("furniture", furniture,
    Field{.doc = "whether planned clutter, furniture and coverings of walls and ceilings are in the building"});
}

}  // namespace plumbline::bim
