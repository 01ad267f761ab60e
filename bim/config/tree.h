// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "bim/config/input_file.h"
#include "bim/errors.h"

namespace plumbline {

/// Plain tree of scalars, lists and ordered maps: the only form in which configuration and results meet YAML and JSON.
/// A YAML scalar is read as text and becomes a number or bool where a field asks for one.
class Tree {
 public:
  struct Null {};
  using List = std::vector<Tree>;
  using Map = std::vector<std::pair<std::string, Tree>>;  ///< insertion order is kept
  using Value = std::variant<Null, bool, std::int64_t, double, std::string, List, Map>;

  Tree() = default;
  Tree(bool v) : value(v) {}
  Tree(int v) : value(static_cast<std::int64_t>(v)) {}
  Tree(std::int64_t v) : value(v) {}
  Tree(double v) : value(v) {}
  Tree(std::string v) : value(std::move(v)) {}
  Tree(std::string_view v) : value(std::string(v)) {}
  Tree(const char* v) : value(std::string(v)) {}
  Tree(List v) : value(std::move(v)) {}
  Tree(Map v) : value(std::move(v)) {}

  [[nodiscard]] static Tree map() { return Tree(Map{}); }
  [[nodiscard]] static Tree list() { return Tree(List{}); }

  [[nodiscard]] bool is_null() const { return std::holds_alternative<Null>(value); }
  [[nodiscard]] bool is_list() const { return std::holds_alternative<List>(value); }
  [[nodiscard]] bool is_map() const { return std::holds_alternative<Map>(value); }
  [[nodiscard]] bool is_scalar() const { return !is_list() && !is_map(); }

  /// Child of a map, or nullptr.
  [[nodiscard]] const Tree* find(std::string_view key) const;
  /// Sets or replaces a key of a map (a Null becomes a map); returns *this for chaining.
  Tree& set(std::string key, Tree child);
  /// Appends to a list (a Null becomes a list).
  Tree& push(Tree child);

  /// Conversions; each throws InputError at `mark` saying what was expected.
  [[nodiscard]] double as_double() const;
  [[nodiscard]] std::int64_t as_int() const;
  [[nodiscard]] bool as_bool() const;
  [[nodiscard]] const std::string& as_string() const;
  [[nodiscard]] const List& as_list() const;
  [[nodiscard]] const Map& as_map() const;

  Value value;
  Mark mark;
};

/// Shortest text that reads back to the same double; "0" for both zeros; throws InternalError on not-a-number and
/// infinity.
[[nodiscard]] std::string format_number(double value);

/// Reads YAML text. Duplicate keys, anchors on cycles, more than one document and nesting deeper than 64 are
/// InputErrors.
[[nodiscard]] Tree read_yaml(std::string_view text, const std::string& file);
[[nodiscard]] std::string write_yaml(const Tree& tree);
[[nodiscard]] Tree read_json(std::string_view text, const std::string& file);
/// indent 0: one line.
[[nodiscard]] std::string write_json(const Tree& tree, int indent = 2);

/// The closest known name to a mistyped one, or empty when none is close.
[[nodiscard]] std::string did_you_mean(std::string_view name, const std::vector<std::string>& known);

}  // namespace plumbline
