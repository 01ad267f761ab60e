// SPDX-License-Identifier: Apache-2.0
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <sstream>

#include "bim/config/nested_tree.h"
#include "bim/config/tree.h"
#include "bim/config/utf8.h"

namespace plumbline {

namespace {

constexpr std::size_t max_depth = 64;

/// UTF-16 and UTF-32, which the parser reads too, hold zeros or begin with a mark that UTF-8 cannot.
void check_utf8(std::string_view text, const std::string& file) {
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff") || text.find('\0') != std::string_view::npos) return;
  Mark mark{file, 1, 1};
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 0) throw InputError(mark, "no UTF-8 text; save the file in that encoding");
    mark.line += text[0] == '\n' ? 1 : 0;
    mark.col = text[0] == '\n' ? 1 : mark.col + 1;
    text.remove_prefix(length);
  }
}

/// Builds the tree from the parser's events, so that every value keeps its place and no key is lost silently.
class TreeBuilder : public YAML::EventHandler {
 public:
  explicit TreeBuilder(std::string file) : file_(std::move(file)) {}

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { nested_.add(at(Tree(), mark)); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    throw InputError(place(mark), "aliases (*name) are not supported; write the value out");
  }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t, const std::string& text) override {
    if (nested_.wants_key())
      nested_.set_key(place(mark), text);
    else
      nested_.add(at(Tree(text), mark));
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
    open(at(Tree::list(), mark), mark);
  }
  void OnSequenceEnd() override { nested_.close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
    open(at(Tree::map(), mark), mark);
  }
  void OnMapEnd() override { nested_.close(); }

  [[nodiscard]] Mark place(const YAML::Mark& mark) const { return {file_, mark.line + 1, mark.column + 1}; }
  [[nodiscard]] Tree take() { return nested_.take(); }

 private:
  Tree at(Tree tree, const YAML::Mark& mark) const {
    tree.mark = place(mark);
    return tree;
  }

  void open(Tree tree, const YAML::Mark& mark) {
    if (nested_.wants_key()) throw InputError(place(mark), "a list or map cannot be a key");
    if (nested_.depth() >= max_depth) throw InputError(place(mark), "nested deeper than 64 levels");
    nested_.open(std::move(tree));
  }

  std::string file_;
  NestedTree nested_;
};

bool needs_quotes(const std::string& text) {
  if (text.empty() || text == "null" || text == "~") return true;
  const bool is_negative = text.size() > 1 && text[0] == '-' && text[1] >= '0' && text[1] <= '9';
  if (text.front() == '-' && !is_negative) return true;
  if (text.front() == ' ' || text.back() == ' ') return true;
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20U || c == 0x7f; };
  return text.find_first_of(":#,?[]{}&*!|>'\"%@`\\") != std::string::npos ||
         std::any_of(text.begin(), text.end(), is_control);
}

std::string scalar_text(const Tree& tree) {
  if (const auto* b = std::get_if<bool>(&tree.value)) return *b ? "true" : "false";
  if (const auto* i = std::get_if<std::int64_t>(&tree.value)) return std::to_string(*i);
  if (const auto* d = std::get_if<double>(&tree.value)) return format_number(*d);
  if (const auto* s = std::get_if<std::string>(&tree.value)) return needs_quotes(*s) ? write_json(Tree(*s), 0) : *s;
  return "~";
}

bool is_flat(const Tree& tree) {
  if (tree.is_scalar()) return true;
  if (tree.is_map()) return tree.as_map().empty();
  for (const Tree& item : tree.as_list())
    if (item.is_map() || !is_flat(item)) return false;
  return true;
}

std::string flow_text(const Tree& tree) {
  if (tree.is_map()) return "{}";
  if (!tree.is_list()) return scalar_text(tree);
  std::string text = "[";
  for (const Tree& item : tree.as_list()) text += (text.size() > 1 ? ", " : "") + flow_text(item);
  return text + "]";
}

void write_block(const Tree& tree, const std::string& indent, bool after_dash, std::string& out) {
  bool first = after_dash;
  const auto lead = [&]() {
    const std::string text = first ? "" : indent;
    first = false;
    return text;
  };
  if (tree.is_map()) {
    for (const auto& [key, child] : tree.as_map()) {
      out += lead() + scalar_text(Tree(key)) + ":";
      if (is_flat(child)) {
        out += " " + flow_text(child) + "\n";
      } else {
        out += "\n";
        write_block(child, indent + "  ", false, out);
      }
    }
    return;
  }
  for (const Tree& item : tree.as_list()) {
    out += lead() + "- ";
    if (is_flat(item))
      out += flow_text(item) + "\n";
    else
      write_block(item, indent + "  ", true, out);
  }
}

}  // namespace

Tree read_yaml(std::string_view text, const std::string& file) {
  check_utf8(text, file);
  std::istringstream stream{std::string(text)};
  TreeBuilder builder(file);
  try {
    YAML::Parser parser(stream);
    if (!parser.HandleNextDocument(builder)) throw InputError({file, 1, 1}, "the file holds no value");
    TreeBuilder second(file);
    if (parser.HandleNextDocument(second)) throw InputError({file, 0, 0}, "more than one document in a file");
  } catch (const YAML::Exception& error) {
    throw InputError(builder.place(error.mark), "no valid YAML: " + error.msg);
  }
  return builder.take();
}

std::string write_yaml(const Tree& tree) {
  if (is_flat(tree)) return flow_text(tree) + "\n";
  std::string out;
  write_block(tree, "", false, out);
  return out;
}

}  // namespace plumbline
