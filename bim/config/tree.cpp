// SPDX-License-Identifier: Apache-2.0
#include "bim/config/tree.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numeric>

namespace plumbline {

namespace {

std::string kind_name(const Tree& tree) {
  static constexpr std::array<const char*, 7> names = {"nothing", "a truth value", "a number", "a number",
                                                       "text",    "a list",        "a map"};
  return names[tree.value.index()];
}

[[noreturn]] void fail(const Tree& tree, const std::string& expected) {
  const auto* text = std::get_if<std::string>(&tree.value);
  const std::string found = text != nullptr ? "'" + *text + "'" : kind_name(tree);
  throw InputError(tree.mark, "found " + found + " where " + expected + " is expected");
}

template <class T>
bool parse_all(const std::string& text, T& value) {
  const char* end = text.data() + text.size();
  const auto [ptr, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && ptr == end;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0U : 1U);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row.back();
}

}  // namespace

const Tree* Tree::find(std::string_view key) const {
  const Map* map = std::get_if<Map>(&value);
  if (map == nullptr) return nullptr;
  const auto it = std::find_if(map->begin(), map->end(), [&](const auto& item) { return item.first == key; });
  return it == map->end() ? nullptr : &it->second;
}

Tree& Tree::set(std::string key, Tree child) {
  if (is_null()) value = Map{};
  Map& map = std::get<Map>(value);
  const auto it = std::find_if(map.begin(), map.end(), [&](const auto& item) { return item.first == key; });
  if (it == map.end())
    map.emplace_back(std::move(key), std::move(child));
  else
    it->second = std::move(child);
  return *this;
}

Tree& Tree::push(Tree child) {
  if (is_null()) value = List{};
  std::get<List>(value).push_back(std::move(child));
  return *this;
}

double Tree::as_double() const {
  if (const auto* d = std::get_if<double>(&value)) return *d;
  if (const auto* i = std::get_if<std::int64_t>(&value)) return static_cast<double>(*i);
  double d = 0.0;
  if (const auto* text = std::get_if<std::string>(&value); text != nullptr && parse_all(*text, d) && std::isfinite(d))
    return d;
  fail(*this, "a number");
}

std::int64_t Tree::as_int() const {
  if (const auto* i = std::get_if<std::int64_t>(&value)) return *i;
  std::int64_t i = 0;
  if (const auto* text = std::get_if<std::string>(&value); text != nullptr && parse_all(*text, i)) return i;
  fail(*this, "a whole number");
}

bool Tree::as_bool() const {
  if (const auto* b = std::get_if<bool>(&value)) return *b;
  if (const auto* text = std::get_if<std::string>(&value)) {
    if (*text == "true") return true;
    if (*text == "false") return false;
  }
  fail(*this, "true or false");
}

const std::string& Tree::as_string() const {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  fail(*this, "text");
}

const Tree::List& Tree::as_list() const {
  if (const auto* list = std::get_if<List>(&value)) return *list;
  fail(*this, "a list");
}

const Tree::Map& Tree::as_map() const {
  if (const auto* map = std::get_if<Map>(&value)) return *map;
  fail(*this, "a map of keys");
}

std::string format_number(double value) {
  if (!std::isfinite(value)) throw InternalError("a result is not a finite number");
  if (value == 0.0) return "0";
  std::array<char, 32> buffer{};
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  if (error != std::errc()) throw InternalError("a number does not fit its text");
  return {buffer.data(), end};
}

std::string did_you_mean(std::string_view name, const std::vector<std::string>& known) {
  std::string best;
  std::size_t best_distance = name.size() / 3 + 2;
  for (const std::string& candidate : known) {
    const std::size_t distance = edit_distance(name, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace plumbline
