// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bim/config/visit.h"

namespace plumbline {

/// One key of a file, as its visit describes it.
struct SchemaField {
  std::string key;  ///< dotted below a nested map
  std::string type;
  std::string unit;      ///< the field's own, else that of the key's ending; "-" for plain numbers
  std::string range;     ///< empty where every value is allowed
  std::string standard;  ///< the default, empty where there is none
  std::string meaning;
  bool required = false;
  bool basic = false;  ///< one of the keys that users change
};

/// The keys of the file itself (no name) or of the entries of one of its lists.
struct SchemaSection {
  std::string name;
  std::string variant;  ///< "op: move_wall" where the first key decides which others there are
  std::vector<SchemaField> fields;
};

/// A struct whose first key decides about the others specialises this with their number, a name for each and how to
/// make it.
template <class T>
struct SchemaVariants {
  static constexpr std::size_t count = 1;
  static std::string name(std::size_t) { return {}; }
  static T make(std::size_t) { return {}; }
};

/// A tree in one line of YAML.
[[nodiscard]] std::string flow_text(const Tree& tree);
[[nodiscard]] SchemaField schema_field(std::string key, std::string type, const Field& field);

/// Lists what a struct's visit lists.
class SchemaVisitor {
 public:
  template <class T>
  [[nodiscard]] static std::vector<SchemaSection> sections_of() {
    std::vector<SchemaSection> sections;
    add_sections<T>(sections, "");
    return sections;
  }

  template <class T>
  void operator()(std::string_view key, T& value, const Field& field = {}) {
    const std::string path = prefix_ + std::string(key);
    if constexpr (requires {
                    requires Visitable<typename T::value_type>;
                    value.has_value();
                  }) {
      typename T::value_type inner;
      (*this)(key, inner, field);
    } else if constexpr (Visitable<T>) {
      const std::size_t first = sections_[section_].fields.size();
      SchemaVisitor inner(sections_, section_, path + ".");
      value.visit(inner);
      if (field.advanced) clear_basic(sections_[section_].fields, first);
    } else {
      SchemaField row = schema_field(path, type_of(value), field);
      if constexpr (!requires { value.has_value(); })
        if (!field.required) row.standard = flow_text(FieldWriter::write(value));
      sections_[section_].fields.push_back(std::move(row));
      add_items(path, value);
    }
  }

 private:
  SchemaVisitor(std::vector<SchemaSection>& sections, std::size_t section, std::string prefix)
      : sections_(sections), section_(section), prefix_(std::move(prefix)) {}

  static void clear_basic(std::vector<SchemaField>& fields, std::size_t first) {
    for (std::size_t i = first; i < fields.size(); ++i) fields[i].basic = false;
  }
  template <class T>
  static void add_sections(std::vector<SchemaSection>& sections, const std::string& name) {
    for (std::size_t i = 0; i < SchemaVariants<T>::count; ++i) {
      T value = SchemaVariants<T>::make(i);
      sections.push_back({name, SchemaVariants<T>::name(i), {}});
      SchemaVisitor visitor(sections, sections.size() - 1, "");
      value.visit(visitor);
    }
  }
  template <class T>
  void add_items(const std::string&, const T&) {}
  template <Visitable T>
  void add_items(const std::string& path, const std::vector<T>&) {
    add_sections<T>(sections_, path);
  }

  template <class T>
  static std::string type_of(const T&) {
    if constexpr (std::is_enum_v<T>) {
      std::string names;
      for (const std::string_view name : EnumNames<T>::names) names += (names.empty() ? "" : ", ") + std::string(name);
      return names;
    } else if constexpr (Visitable<T>) {
      return "entry";
    } else if constexpr (std::same_as<T, bool>) {
      return "true, false";
    } else if constexpr (std::is_integral_v<T>) {
      return "integer";
    } else if constexpr (std::is_floating_point_v<T>) {
      return "number";
    } else if constexpr (std::same_as<T, Eigen::Vector2d>) {
      return "[x, y]";
    } else {
      return "text";
    }
  }
  template <class T>
  static std::string type_of(const std::optional<T>&) {
    return type_of(T());
  }
  template <class T>
  static std::string type_of(const std::vector<T>&) {
    return "list of " + type_of(T());
  }

  std::vector<SchemaSection>& sections_;
  std::size_t section_;
  std::string prefix_;
};

/// The basic fields; all of them where none is basic.
[[nodiscard]] std::vector<SchemaField> basic_fields(const std::vector<SchemaField>& fields);
/// YAML with every key of a file without lists of entries at its default, each with its description as a comment.
[[nodiscard]] std::string schema_yaml(const std::vector<SchemaField>& fields);
/// A Markdown table of these keys.
[[nodiscard]] std::string schema_table(const std::vector<SchemaField>& fields);
/// Markdown: for each section its heading and the table of its keys.
[[nodiscard]] std::string schema_tables(const std::vector<SchemaSection>& sections);

}  // namespace plumbline
