// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "bim/config/tree.h"

namespace plumbline {

namespace {

constexpr int max_depth = 64;

Tree convert(const nlohmann::ordered_json& json, const Mark& mark, int depth) {
  if (depth > max_depth) throw InputError(mark, "nested deeper than 64 levels");
  Tree tree;
  switch (json.type()) {
    case nlohmann::json::value_t::boolean:
      tree.value = json.get<bool>();
      break;
    case nlohmann::json::value_t::number_unsigned:
      if (json.get<std::uint64_t>() > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
        throw InputError(mark, "the number " + std::to_string(json.get<std::uint64_t>()) +
                                   " is too large; at most 9223372036854775807 would be right");
      [[fallthrough]];
    case nlohmann::json::value_t::number_integer:
      tree.value = json.get<std::int64_t>();
      break;
    case nlohmann::json::value_t::number_float:
      tree.value = json.get<double>();
      break;
    case nlohmann::json::value_t::string:
      tree.value = json.get<std::string>();
      break;
    case nlohmann::json::value_t::array:
      tree = Tree::list();
      for (const auto& item : json) tree.push(convert(item, mark, depth + 1));
      break;
    case nlohmann::json::value_t::object:
      tree = Tree::map();
      for (const auto& [key, item] : json.items()) tree.set(key, convert(item, mark, depth + 1));
      break;
    default:
      break;
  }
  tree.mark = mark;
  return tree;
}

/// Told what the parser comes to. Of two equal keys in a map it would keep one and say nothing.
struct UniqueKeys {
  Mark mark;
  std::vector<std::set<std::string>> maps;  ///< keys of those that are open

  bool operator()(int /*depth*/, nlohmann::ordered_json::parse_event_t event, const nlohmann::ordered_json& parsed) {
    using Event = nlohmann::ordered_json::parse_event_t;
    if (event == Event::object_start) maps.emplace_back();
    if (event == Event::object_end) maps.pop_back();
    if (event == Event::key && !maps.back().insert(parsed.get<std::string>()).second)
      throw InputError(mark, "duplicate key '" + parsed.get<std::string>() + "'; each key may stand once");
    return true;
  }
};

std::string quoted(const std::string& text) {
  static constexpr char hex[] = "0123456789abcdef";
  std::string out = "\"";
  for (const char c : text) {
    const auto u = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (c == '\n') {
      out += "\\n";
    } else if (c == '\t') {
      out += "\\t";
    } else if (u < 0x20U) {
      out += "\\u00";
      out += hex[u >> 4U];
      out += hex[u & 15U];
    } else {
      out += c;
    }
  }
  return out + "\"";
}

void write(const Tree& tree, int indent, int depth, std::string& out);

/// Writes the items of a list or map between brackets; `item(i)` writes the i-th.
template <class Item>
void write_items(char open, char close, std::size_t count, bool flat, int indent, int depth, std::string& out,
                 const Item& item) {
  const auto newline = [&](int level) {
    if (!flat) out += "\n" + std::string(static_cast<std::size_t>(level * indent), ' ');
  };
  out += open;
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0) out += flat && indent > 0 ? ", " : ",";
    newline(depth + 1);
    item(i);
  }
  if (count > 0) newline(depth);
  out += close;
}

void write(const Tree& tree, int indent, int depth, std::string& out) {
  if (const auto* list = std::get_if<Tree::List>(&tree.value)) {
    bool flat = indent == 0;
    if (!flat) flat = std::all_of(list->begin(), list->end(), [](const Tree& item) { return item.is_scalar(); });
    write_items('[', ']', list->size(), flat, indent, depth, out,
                [&](std::size_t i) { write((*list)[i], indent, depth + 1, out); });
  } else if (const auto* map = std::get_if<Tree::Map>(&tree.value)) {
    write_items('{', '}', map->size(), indent == 0, indent, depth, out, [&](std::size_t i) {
      out += quoted((*map)[i].first) + (indent == 0 ? ":" : ": ");
      write((*map)[i].second, indent, depth + 1, out);
    });
  } else if (const auto* b = std::get_if<bool>(&tree.value)) {
    out += *b ? "true" : "false";
  } else if (const auto* i = std::get_if<std::int64_t>(&tree.value)) {
    out += std::to_string(*i);
  } else if (const auto* d = std::get_if<double>(&tree.value)) {
    out += format_number(*d);
  } else if (const auto* s = std::get_if<std::string>(&tree.value)) {
    out += quoted(*s);
  } else {
    out += "null";
  }
}

}  // namespace

Tree read_json(std::string_view text, const std::string& file) {
  try {
    UniqueKeys unique{{file, 0, 0}, {}};
    return convert(nlohmann::ordered_json::parse(text.begin(), text.end(), std::ref(unique)), {file, 0, 0}, 0);
  } catch (const nlohmann::json::parse_error& error) {
    int line = 1;
    int col = 1;
    for (std::size_t i = 0; i + 1 < error.byte && i < text.size(); ++i) {
      col = text[i] == '\n' ? 1 : col + 1;
      line += text[i] == '\n' ? 1 : 0;
    }
    throw InputError({file, line, col}, "no valid JSON");
  } catch (const nlohmann::json::exception& error) {
    throw InputError({file, 0, 0}, std::string("no valid JSON: ") + error.what());
  }
}

std::string write_json(const Tree& tree, int indent) {
  std::string out;
  write(tree, indent, 0, out);
  return out;
}

}  // namespace plumbline
