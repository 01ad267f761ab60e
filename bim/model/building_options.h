// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/config/visit.h"

namespace plumbline::bim {

enum class Doors { as_designed, open, closed };

/// What a scenario may say about a building without touching its file.
struct BuildingOptions {
  Doors doors = Doors::as_designed;  ///< state of every door leaf
  bool furniture = true;             ///< false: the planned clutter, furniture and coverings are left out

  template <class V>
  void visit(V& v);
};

}  // namespace plumbline::bim

namespace plumbline {

template <>
struct EnumNames<bim::Doors> {
  static constexpr std::array<std::string_view, 3> names = {"as_designed", "open", "closed"};
};

}  // namespace plumbline

namespace plumbline::bim {

template <class V>
void BuildingOptions::visit(V& v) {
  v("doors", doors, Field{.doc = "leaf of every door that has one"});
  v("furniture", furniture, Field{.doc = "false: planned clutter, furniture and coverings are left out"});
}

}  // namespace plumbline::bim
