// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bim/config/schema.h"
#include "bim/config/tree.h"

/// Whether the examples of a file have a value for each of its keys.
namespace plumbline {

namespace schema_example {

/// The value at a dotted key of a map, or nullptr.
inline const Tree* value_at(const Tree& map, std::string_view key) {
  const Tree* node = &map;
  while (node != nullptr && !key.empty()) {
    const std::size_t dot = key.find('.');
    node = node->is_map() ? node->find(key.substr(0, dot)) : nullptr;
    key = dot == std::string_view::npos ? "" : key.substr(dot + 1);
  }
  return node;
}

/// True when the entry is of the section's variant, "key: value".
inline bool is_of_variant(const Tree& entry, std::string_view variant) {
  if (variant.empty()) return true;
  const std::size_t colon = variant.find(": ");
  const Tree* value = entry.find(variant.substr(0, colon));
  return value != nullptr && value->as_string() == variant.substr(colon + 2);
}

inline std::string example_in(const Tree& example, const SchemaSection& section, const SchemaField& field) {
  if (section.name.empty()) {
    const Tree* value = value_at(example, field.key);
    return value == nullptr ? "" : flow_text(*value);
  }
  const Tree* entries = value_at(example, section.name);
  if (entries == nullptr || !entries->is_list()) return "";
  for (const Tree& entry : entries->as_list())
    if (const Tree* value = value_at(entry, field.key); value != nullptr && is_of_variant(entry, section.variant))
      return flow_text(*value);
  return "";
}

}  // namespace schema_example

/// The first value of this key in examples of the file, as text; empty when they have none.
[[nodiscard]] inline std::string example_of(const std::vector<Tree>& examples, const SchemaSection& section,
                                            const SchemaField& field) {
  for (const Tree& example : examples)
    if (std::string text = schema_example::example_in(example, section, field); !text.empty()) return text;
  return "";
}

}  // namespace plumbline
