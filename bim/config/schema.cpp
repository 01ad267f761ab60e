// SPDX-License-Identifier: Apache-2.0
#include "bim/config/schema.h"

#include <array>
#include <cmath>

namespace plumbline {

namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 6> units = {
    {{"_mm", "mm"}, {"_m", "m"}, {"_deg", "°"}, {"_mps", "m/s"}, {"_s", "s"}, {"_n", "N"}}};

std::string unit_of(std::string_view key) {
  for (const auto& [ending, unit] : units)
    if (key.size() > ending.size() && key.substr(key.size() - ending.size()) == ending) return std::string(unit);
  return key == "deg" ? "°" : "";
}

std::string range_of(const Field& field) {
  const bool low = std::isfinite(field.min), high = std::isfinite(field.max);
  if (low && high && field.min == field.max) return format_number(field.min);
  if (low && high) return format_number(field.min) + " to " + format_number(field.max);
  if (low) return "at least " + format_number(field.min);
  return high ? "at most " + format_number(field.max) : "";
}

/// The value at a dotted key of a map, or nullptr.
const Tree* value_at(const Tree& map, std::string_view key) {
  const Tree* node = &map;
  while (node != nullptr && !key.empty()) {
    const std::size_t dot = key.find('.');
    node = node->is_map() ? node->find(key.substr(0, dot)) : nullptr;
    key = dot == std::string_view::npos ? "" : key.substr(dot + 1);
  }
  return node;
}

/// True when the entry is of the section's variant, "key: value".
bool is_of_variant(const Tree& entry, std::string_view variant) {
  if (variant.empty()) return true;
  const std::size_t colon = variant.find(": ");
  const Tree* value = entry.find(variant.substr(0, colon));
  return value != nullptr && value->as_string() == variant.substr(colon + 2);
}

std::string code(const std::string& text) { return text.empty() ? "" : "`" + text + "`"; }

}  // namespace

std::string flow_text(const Tree& tree) {
  std::string text;
  if (tree.is_list()) {
    for (const Tree& item : tree.as_list()) text += (text.empty() ? "" : ", ") + flow_text(item);
    return "[" + text + "]";
  }
  if (tree.is_map()) {
    for (const auto& [key, child] : tree.as_map()) text += (text.empty() ? "" : ", ") + key + ": " + flow_text(child);
    return "{" + text + "}";
  }
  if (const auto* string = std::get_if<std::string>(&tree.value)) return *string;
  return tree.is_null() ? "" : write_json(tree, 0);
}

SchemaField schema_field(std::string key, std::string type, const Field& field) {
  SchemaField row;
  row.unit = unit_of(key);
  row.key = std::move(key);
  row.type = std::move(type);
  row.range = range_of(field);
  row.meaning = field.doc;
  row.required = field.required;
  return row;
}

namespace {

std::string example_in(const Tree& example, const SchemaSection& section, const SchemaField& field) {
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

}  // namespace

std::string example_of(const std::vector<Tree>& examples, const SchemaSection& section, const SchemaField& field) {
  for (const Tree& example : examples)
    if (std::string text = example_in(example, section, field); !text.empty()) return text;
  return "";
}

std::string schema_yaml(const std::vector<SchemaField>& fields) {
  std::string text, last;
  for (const SchemaField& field : fields) {
    std::string indent;
    for (std::size_t dot = field.key.find('.'), from = 0; dot != std::string::npos; dot = field.key.find('.', from)) {
      const std::string map = field.key.substr(0, dot + 1);
      if (last.substr(0, map.size()) != map) text += indent + field.key.substr(from, dot - from) + ":\n";
      indent += "  ";
      from = dot + 1;
    }
    last = field.key;
    std::string said = field.meaning;
    if (!field.range.empty()) said += (said.empty() ? "" : " ") + ("(" + field.range + ")");
    text += indent + field.key.substr(field.key.rfind('.') + 1) + ": " + field.standard;
    text += said.empty() ? "\n" : "  # " + said + "\n";
  }
  return text;
}

std::string schema_tables(const std::vector<SchemaSection>& sections, const std::vector<Tree>& examples) {
  std::string page, last;
  for (const SchemaSection& section : sections) {
    if (section.name != last) page += "## `" + section.name + "`: a list, of each entry\n\n";
    last = section.name;
    if (!section.variant.empty()) page += "### `" + section.variant + "`\n\n";
    page += "| key | value | unit | range | default | example | |\n|---|---|---|---|---|---|---|\n";
    for (const SchemaField& field : section.fields) {
      const bool list = field.type == "list of entry";
      page += "| `" + field.key + "` | " + (list ? "list, below" : field.type) + " | " + field.unit + " | " +
              field.range + " | " + (field.required ? "**required**" : code(field.standard)) + " | " +
              (list ? "" : code(example_of(examples, section, field))) + " | " + field.meaning + " |\n";
    }
    page += "\n";
  }
  return page;
}

}  // namespace plumbline
