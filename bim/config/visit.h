// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <concepts>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "bim/config/tree.h"

namespace plumbline {

/// What a visit says of one field besides its key and value. This is the field's one description: the member it belongs
/// to has none of its own.
struct Field {
  std::string_view doc = {};   ///< one sentence without its full stop
  std::string_view unit = {};  ///< where the key's ending does not say it; "-" for plain numbers; integers need none
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool required = false;
  bool basic = false;            ///< shown without --all: a key that users change
  bool advanced = false;         ///< of a nested struct: none of its keys is basic here
  std::string_view former = {};  ///< the key's name in the version before; refused with the new one
};

/// Field of a plain number, which needs no unit.
[[nodiscard]] constexpr Field plain_field(std::string_view doc, Field more = {}) {
  more.doc = doc;
  more.unit = "-";
  return more;
}

/// Field of a share: a plain number from 0 to 1.
[[nodiscard]] constexpr Field share_field(std::string_view doc, Field more = {}) {
  more.min = 0.0;
  more.max = 1.0;
  return plain_field(doc, more);
}

/// Names of an enumeration, in the order of its values, by a function that stands beside it:
///   constexpr std::array<std::string_view, 2> names_of(Side) { return {"one", "both"}; }
template <class E>
struct EnumNames {
  static constexpr auto names = names_of(E{});
};

class FieldReader;
class FieldWriter;

/// A configuration struct lists each field once:
///   template <class V> void visit(V& v) { v("speed_mps", speed_mps, Field{.doc = "walking speed", .min = 0.05}); }
template <class T>
concept EigenValue = requires {
  typename T::Scalar;
};
template <class T>
concept Visitable = !EigenValue<T> && requires(T t, FieldReader& r) {
  t.visit(r);
};

void read_scalar(const Tree& tree, std::string_view key, const Field& field, double& value);
void read_scalar(const Tree& tree, std::string_view key, const Field& field, int& value);
void read_scalar(const Tree& tree, std::string_view key, const Field& field, std::uint64_t& value);
void read_scalar(const Tree& tree, std::string_view key, const Field& field, bool& value);
void read_scalar(const Tree& tree, std::string_view key, const Field& field, std::string& value);
/// Index of the name, or InputError with the choices and a did-you-mean.
std::size_t read_choice(const Tree& tree, std::string_view key, const std::string_view* names, std::size_t count);

/// Reads a struct from a map: unknown keys, wrong types and values out of range are InputErrors with their place.
class FieldReader {
 public:
  explicit FieldReader(const Tree& map);

  template <class T>
  void operator()(std::string_view key, T& value, const Field& field = {}) {
    known_.emplace_back(key);
    if (!field.former.empty()) former_.emplace_back(field.former, key);
    const Tree* child = map_.find(key);
    if (child == nullptr) {
      if (field.required) fail_missing(key);
      return;
    }
    read(*child, key, field, value);
  }

  /// Call after the last field: rejects keys that no field named.
  void finish() const;

  template <class T>
  static void read(const Tree& tree, std::string_view key, const Field& field, T& value) {
    if constexpr (std::is_enum_v<T>) {
      value = static_cast<T>(read_choice(tree, key, EnumNames<T>::names.data(), EnumNames<T>::names.size()));
    } else if constexpr (Visitable<T>) {
      FieldReader reader(tree);
      value.visit(reader);
      reader.finish();
    } else {
      read_value(tree, key, field, value);
    }
  }

 private:
  template <class T>
  static void read_value(const Tree& tree, std::string_view key, const Field& field, std::vector<T>& value) {
    value.clear();
    for (const Tree& item : tree.as_list()) read(item, key, field, value.emplace_back());
  }
  template <class T>
  static void read_value(const Tree& tree, std::string_view key, const Field& field, std::optional<T>& value) {
    read(tree, key, field, value.emplace());
  }
  static void read_value(const Tree& tree, std::string_view key, const Field& field, Eigen::Vector2d& value);
  template <class T>
  static void read_value(const Tree& tree, std::string_view key, const Field& field, T& value) {
    read_scalar(tree, key, field, value);
  }

  [[noreturn]] void fail_missing(std::string_view key) const;

  const Tree& map_;
  std::vector<std::string> known_;
  std::vector<std::pair<std::string, std::string>> former_;  ///< old name, new name
};

/// Writes a struct as a map, every field, in the order of its visit. Empty optionals are left out.
class FieldWriter {
 public:
  template <class T>
  void operator()(std::string_view key, const T& value, const Field& = {}) {
    if constexpr (requires { value.has_value(); }) {
      if (value.has_value()) map_.set(std::string(key), write(*value));
    } else {
      map_.set(std::string(key), write(value));
    }
  }

  template <class T>
  static Tree write(const T& value) {
    if constexpr (std::is_enum_v<T>) {
      return Tree(EnumNames<T>::names[static_cast<std::size_t>(value)]);
    } else if constexpr (Visitable<T>) {
      FieldWriter writer;
      T copy = value;
      copy.visit(writer);
      return writer.map_;
    } else if constexpr (std::same_as<T, std::uint64_t>) {
      return Tree(static_cast<std::int64_t>(value));
    } else if constexpr (std::same_as<T, Eigen::Vector2d>) {
      return Tree(Tree::List{Tree(value.x()), Tree(value.y())});
    } else if constexpr (requires { value.begin(); } && !std::same_as<T, std::string>) {
      Tree list = Tree::list();
      for (const auto& item : value) list.push(write(item));
      return list;
    } else {
      return Tree(value);
    }
  }

 private:
  Tree map_ = Tree::map();
};

/// Reads a whole struct; `tree` must be a map.
template <class T>
[[nodiscard]] T from_tree(const Tree& tree) {
  T value;
  FieldReader::read(tree, "", {}, value);
  return value;
}

template <class T>
[[nodiscard]] Tree to_tree(const T& value) {
  return FieldWriter::write(value);
}

}  // namespace plumbline
