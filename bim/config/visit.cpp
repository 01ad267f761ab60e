// SPDX-License-Identifier: Apache-2.0
#include "bim/config/visit.h"

#include <algorithm>
#include <cmath>

namespace plumbline {

namespace {

/// The key before what is wrong with its value; an option of the command line is named by the mark already.
std::string named(const Tree& tree, std::string_view key) {
  return key.empty() || tree.mark.file.starts_with("--") ? "" : "'" + std::string(key) + "': ";
}

void check_range(const Tree& tree, std::string_view key, const Field& field, double value) {
  if (value >= field.min && value <= field.max) return;
  std::string range;
  if (field.min == field.max)
    range = format_number(field.min);
  else if (std::isinf(field.max))
    range = "at least " + format_number(field.min);
  else if (std::isinf(field.min))
    range = "at most " + format_number(field.max);
  else
    range = "between " + format_number(field.min) + " and " + format_number(field.max);
  throw InputError(tree.mark, named(tree, key) + format_number(value) + " is out of range; it must be " + range);
}

/// Adds the key to what a conversion complains about.
template <class Convert>
decltype(auto) convert(const Tree& tree, std::string_view key, const Convert& function) {
  try {
    return function();
  } catch (const InputError& error) {
    const std::string prefix = to_string(tree.mark) + ": ";
    const std::string what = error.what();
    const bool has_prefix = what.rfind(prefix, 0) == 0;
    throw InputError(tree.mark, named(tree, key) + (has_prefix ? what.substr(prefix.size()) : what));
  }
}

}  // namespace

void read_scalar(const Tree& tree, std::string_view key, const Field& field, double& value) {
  value = convert(tree, key, [&] { return tree.as_double(); });
  check_range(tree, key, field, value);
}

void read_scalar(const Tree& tree, std::string_view key, const Field& field, int& value) {
  const std::int64_t wide = convert(tree, key, [&] { return tree.as_int(); });
  check_range(tree, key, field, static_cast<double>(wide));
  if (wide < std::numeric_limits<int>::min() || wide > std::numeric_limits<int>::max())
    throw InputError(tree.mark, named(tree, key) + std::to_string(wide) + " is too large");
  value = static_cast<int>(wide);
}

void read_scalar(const Tree& tree, std::string_view key, const Field& field, std::uint64_t& value) {
  const std::int64_t wide = convert(tree, key, [&] { return tree.as_int(); });
  check_range(tree, key, field, static_cast<double>(wide));
  if (wide < 0)
    throw InputError(tree.mark, named(tree, key) + std::to_string(wide) + " is negative; it must be at least 0");
  value = static_cast<std::uint64_t>(wide);
}

void read_scalar(const Tree& tree, std::string_view key, const Field&, bool& value) {
  value = convert(tree, key, [&] { return tree.as_bool(); });
}

void read_scalar(const Tree& tree, std::string_view key, const Field&, std::string& value) {
  value = convert(tree, key, [&] { return tree.as_string(); });
}

std::size_t read_choice(const Tree& tree, std::string_view key, const std::string_view* names, std::size_t count) {
  const std::string text = convert(tree, key, [&] { return tree.as_string(); });
  const auto* found = std::find(names, names + count, text);
  if (found != names + count) return static_cast<std::size_t>(found - names);
  std::string message = named(tree, key) + "'" + text + "' is not one of ";
  for (std::size_t i = 0; i < count; ++i) message += (i > 0 ? ", " : "") + std::string(names[i]);
  const std::string guess = did_you_mean(text, std::vector<std::string>(names, names + count));
  throw InputError(tree.mark, message + (guess.empty() ? "" : "; did you mean '" + guess + "'?"));
}

FieldReader::FieldReader(const Tree& map) : map_(map) { static_cast<void>(map.as_map()); }

void FieldReader::finish() const {
  for (const auto& entry : map_.as_map()) {
    const std::string& key = entry.first;  // clang 14 captures no structured binding
    const Tree& child = entry.second;
    if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
    const auto renamed =
        std::find_if(former_.begin(), former_.end(), [&](const auto& name) { return name.first == key; });
    if (renamed != former_.end())
      throw InputError(child.mark, "the key '" + key + "' is now called '" + renamed->second + "'");
    const std::string guess = did_you_mean(key, known_);
    std::string message = "unknown key '" + key + "'";
    if (!guess.empty()) {
      message += "; did you mean '" + guess + "'?";
    } else {
      message += "; known here:";
      for (const std::string& name : known_) message += " " + name;
    }
    throw InputError(child.mark, message);
  }
}

void FieldReader::fail_missing(std::string_view key) const {
  std::vector<std::string> others;
  for (const auto& [other, child] : map_.as_map()) {
    const bool named = std::find(known_.begin(), known_.end(), other) != known_.end();
    if (!named && std::min(other.size(), key.size()) > 2) others.push_back(other);  // shorter names are all alike
  }
  const std::string meant = did_you_mean(key, others);
  throw InputError(
      meant.empty() ? map_.mark : map_.find(meant)->mark,
      "the key '" + std::string(key) + "' is missing" + (meant.empty() ? "" : "; is '" + meant + "' meant to be it?"));
}

void FieldReader::read_value(const Tree& tree, std::string_view key, const Field& field, Eigen::Vector2d& value) {
  const Tree::List& list = convert(tree, key, [&]() -> const Tree::List& { return tree.as_list(); });
  if (list.size() != 2) throw InputError(tree.mark, named(tree, key) + "two numbers [x, y] are expected");
  read_scalar(list[0], key, field, value.x());
  read_scalar(list[1], key, field, value.y());
}

}  // namespace plumbline
