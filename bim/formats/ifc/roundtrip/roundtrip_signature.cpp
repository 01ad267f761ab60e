// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/roundtrip/roundtrip_signature.h"

#include <array>
#include <utility>

#include "bim/digest/digest.h"
#include "bim/formats/ifc/step/step_string.h"

namespace plumbline::bim {
namespace {

template <class Value, std::size_t n>
using Names = std::array<std::pair<Value, std::string_view>, n>;

constexpr Names<StoreyKind, 3> storey_kinds{
    {{StoreyKind::habitable, "habitable"}, {StoreyKind::foundation, "foundation"}, {StoreyKind::roof, "roof"}}};
constexpr Names<OpeningKind, 3> opening_kinds{
    {{OpeningKind::door, "door"}, {OpeningKind::window, "window"}, {OpeningKind::opening_void, "void"}}};
constexpr Names<Leaf, 3> leaves{{{Leaf::open, "open"}, {Leaf::closed, "closed"}, {Leaf::none, "none"}}};

template <class Value, std::size_t n>
std::string_view name_in(const Names<Value, n>& names, Value value) {
  for (const auto& [known, name] : names)
    if (known == value) return name;
  return {};
}

template <class Value, std::size_t n>
std::optional<Value> value_in(const Names<Value, n>& names, std::string_view name) {
  for (const auto& [value, known] : names)
    if (known == name) return value;
  return std::nullopt;
}

}  // namespace

std::string roundtrip_signature(std::string_view entities) {
  std::string text;
  for (const char c : entities)
    if (c != '\r') text += c;
  return "Plumbline [1 " + Digest().add(text).hex() + "]";
}

bool has_roundtrip_signature(std::string_view text) {
  // A line break within a string is escaped, so these are no part of one.
  const std::size_t data = text.find("\nDATA;"), end = text.rfind("\nENDSEC;");
  if (data == std::string_view::npos || end == std::string_view::npos) return false;
  const std::size_t first = text.find('#', data);
  if (first > end) return false;
  const std::size_t mark =
      text.substr(0, data).find(step_string(roundtrip_signature(text.substr(first, end + 1 - first))));
  return mark != std::string_view::npos;
}

std::string_view name_of(StoreyKind kind) { return name_in(storey_kinds, kind); }
std::string_view name_of(OpeningKind kind) { return name_in(opening_kinds, kind); }
std::string_view name_of(Leaf leaf) { return name_in(leaves, leaf); }
std::optional<StoreyKind> storey_kind_of(std::string_view name) { return value_in(storey_kinds, name); }
std::optional<OpeningKind> opening_kind_of(std::string_view name) { return value_in(opening_kinds, name); }
std::optional<Leaf> leaf_of(std::string_view name) { return value_in(leaves, name); }

}  // namespace plumbline::bim
