// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>

#include "bim/config/nested_tree.h"
#include "bim/config/tree.h"

namespace plumbline {

namespace {

constexpr std::size_t max_depth = 64;

/// Builds the tree from the parser's events. The parser's own maps would seek each key among all before it, and of two
/// equal ones keep one and say nothing.
class TreeReader : public nlohmann::json::json_sax_t {
 public:
  TreeReader(std::string_view text, const std::string& file) : text_(text), mark_{file, 0, 0} {}

  bool null() override { return add(Tree()); }
  bool boolean(bool value) override { return add(Tree(value)); }
  bool number_integer(std::int64_t value) override { return add(Tree(value)); }
  bool number_unsigned(std::uint64_t value) override {
    if (value > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
      throw InputError(
          mark_, "the number " + std::to_string(value) + " is too large; at most 9223372036854775807 would be right");
    return add(Tree(static_cast<std::int64_t>(value)));
  }
  bool number_float(double value, const std::string&) override { return add(Tree(value)); }
  bool string(std::string& value) override { return add(Tree(std::move(value))); }
  bool binary(nlohmann::json::binary_t&) override { return false; }  // of other formats than JSON
  bool start_object(std::size_t) override { return open(Tree::map()); }
  bool end_object() override { return close(); }
  bool start_array(std::size_t) override { return open(Tree::list()); }
  bool end_array() override { return close(); }
  bool key(std::string& value) override {
    nested_.set_key(mark_, std::move(value));
    return true;
  }
  bool parse_error(std::size_t byte, const std::string&, const nlohmann::json::exception& error) override {
    if (dynamic_cast<const nlohmann::json::parse_error*>(&error) == nullptr)
      throw InputError(mark_, std::string("no valid JSON: ") + error.what());
    Mark mark{mark_.file, 1, 1};
    for (std::size_t i = 0; i + 1 < byte && i < text_.size(); ++i) {
      mark.col = text_[i] == '\n' ? 1 : mark.col + 1;
      mark.line += text_[i] == '\n' ? 1 : 0;
    }
    throw InputError(mark, "no valid JSON");
  }

  [[nodiscard]] Tree take() { return nested_.take(); }

 private:
  [[nodiscard]] Tree checked(Tree tree) const {
    if (nested_.depth() > max_depth) throw InputError(mark_, "nested deeper than 64 levels");
    tree.mark = mark_;
    return tree;
  }
  bool open(Tree tree) {
    nested_.open(checked(std::move(tree)));
    return true;
  }
  bool close() {
    nested_.close();
    return true;
  }
  bool add(Tree tree) {
    nested_.add(checked(std::move(tree)));
    return true;
  }

  std::string_view text_;
  Mark mark_;
  NestedTree nested_;
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
  TreeReader reader(text, file);
  try {
    if (!nlohmann::json::sax_parse(text.begin(), text.end(), &reader)) throw InputError({file, 0, 0}, "no valid JSON");
  } catch (const nlohmann::json::exception& error) {
    throw InputError({file, 0, 0}, std::string("no valid JSON: ") + error.what());
  }
  return reader.take();
}

std::string write_json(const Tree& tree, int indent) {
  std::string out;
  write(tree, indent, 0, out);
  return out;
}

}  // namespace plumbline
