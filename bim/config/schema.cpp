// SPDX-License-Identifier: Apache-2.0
#include "bim/config/schema.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "bim/config/markdown.h"

namespace plumbline {

namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 9> units = {{{"_mm", "mm"},
                                                                                 {"_m", "m"},
                                                                                 {"_m2", "m²"},
                                                                                 {"_deg", "°"},
                                                                                 {"_rad", "rad"},
                                                                                 {"_mps", "m/s"},
                                                                                 {"_radps", "rad/s"},
                                                                                 {"_s", "s"},
                                                                                 {"_n", "N"}}};

constexpr std::string_view plain_number = "-";

/// Of the key's ending; the unit of a rate (..._per_m) stands in its field.
std::string unit_of(std::string_view key) {
  for (const auto& [ending, unit] : units)
    if (key.ends_with(ending) && !key.ends_with("_per" + std::string(ending))) return std::string(unit);
  return key == "deg" ? "°" : "";
}

/// 100000 rather than 1e+05.
std::string limit_text(double limit) {
  constexpr double longest = 1e9;
  if (limit == std::trunc(limit) && std::abs(limit) < longest) return std::to_string(std::lround(limit));
  return format_number(limit);
}

std::string range_of(const Field& field) {
  const bool low = std::isfinite(field.min), high = std::isfinite(field.max);
  if (low && high && field.min == field.max) return limit_text(field.min);
  if (low && high) return limit_text(field.min) + " to " + limit_text(field.max);
  if (low) return "at least " + limit_text(field.min);
  return high ? "at most " + limit_text(field.max) : "";
}

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
  row.unit = field.unit.empty() ? unit_of(key) : std::string(field.unit);
  if (row.unit.empty() && type == "integer") row.unit = plain_number;
  row.key = std::move(key);
  row.type = std::move(type);
  row.range = range_of(field);
  row.meaning = field.doc;
  row.required = field.required;
  row.basic = field.basic;
  return row;
}

std::vector<SchemaField> basic_fields(const std::vector<SchemaField>& fields) {
  std::vector<SchemaField> basic;
  std::copy_if(fields.begin(), fields.end(), std::back_inserter(basic), [](const auto& field) { return field.basic; });
  return basic.empty() ? fields : basic;
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
    std::string limits = field.unit == plain_number ? "" : field.unit;
    if (!field.range.empty()) limits += (limits.empty() ? "" : ", ") + field.range;
    std::string comment = field.meaning;
    if (!limits.empty()) comment += (comment.empty() ? "(" : " (") + limits + ")";
    text += indent + field.key.substr(field.key.rfind('.') + 1) + ": " + field.standard;
    text += comment.empty() ? "\n" : "  # " + comment + "\n";
  }
  return text;
}

std::string schema_table(const std::vector<SchemaField>& fields) {
  MarkdownTable table({"key", "value", "unit", "range", "default", "meaning"});
  for (const SchemaField& field : fields)
    table.add({markdown_code(field.key), field.type == "list of entry" ? "list, below" : field.type, field.unit,
               field.range, field.required ? "required" : markdown_code(field.standard), field.meaning});
  return table.text();
}

std::string schema_tables(const std::vector<SchemaSection>& sections) {
  std::string page, last;
  for (const SchemaSection& section : sections) {
    if (!page.empty()) page += "\n";
    if (section.name != last) page += "## Entries of `" + section.name + "`\n\n";
    last = section.name;
    if (!section.variant.empty()) page += "### `" + section.variant + "`\n\n";
    page += schema_table(section.fields);
  }
  return page;
}

}  // namespace plumbline
