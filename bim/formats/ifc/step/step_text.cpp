// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_text.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>

#include "bim/config/utf8.h"
#include "bim/errors.h"

namespace plumbline::bim {
namespace {

constexpr std::string_view opening_line = "ISO-10303-21";
constexpr std::string_view closing_line = "END-ISO-10303-21";
constexpr std::string_view comment_begin = "/*", comment_end = "*/";

/// A statement up to its semicolon, without it.
struct Statement {
  std::string_view text;
  int line = 0;
};

/// Splits STEP text into statements, with regard to strings, comments and brackets.
class StatementReader {
 public:
  StatementReader(std::string_view text, const std::string& file, const StepLimits& limits)
      : text_(text), file_(file), limits_(limits) {}

  /// Next statement. Throws InputError where the text ends within one.
  Statement next() {
    skip_blanks();
    const std::size_t begin = at_;
    const int line = line_;
    int depth = 0;
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == ';' && depth == 0) return {text_.substr(begin, at_++ - begin), line};
      if (c == '(' && ++depth > limits_.nesting) fail("brackets nested deeper than " + std::to_string(limits_.nesting));
      if (c == ')' && --depth < 0) fail("a closing bracket without its opening one");
      if (c == ';') fail("a semicolon within brackets");
      if (text_.substr(at_).starts_with(comment_begin)) fail_open_comment();
      if (c == '\'') {
        skip_string();
      } else {
        step();
      }
    }
    fail_cut();
  }

  [[nodiscard]] bool at_end() {
    skip_blanks();
    return at_ >= text_.size();
  }

  [[noreturn]] void fail(const std::string& what) const { throw InputError({file_, line_, 0}, what); }

  [[noreturn]] void fail_open_comment() const { fail("a comment begins here and does not end"); }

  [[noreturn]] void fail_cut() const {
    const bool line_begun = !text_.empty() && text_.back() != '\n';
    throw InputError({file_, line_, 0}, std::string("the file ends ") + (line_begun ? "in the middle of" : "before") +
                                            " line " + std::to_string(line_) + "; an IFC file ends with " +
                                            std::string(closing_line) + ";");
  }

 private:
  void step() {
    if (text_[at_] == '\n') ++line_;
    ++at_;
  }

  void skip_string() {
    step();
    while (at_ < text_.size() && text_[at_] != '\'') step();
    if (at_ >= text_.size()) fail_cut();
    step();
  }

  void skip_blanks() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) step();
  }

  std::string_view text_;
  const std::string& file_;
  StepLimits limits_;
  std::size_t at_ = 0;
  int line_ = 1;
};

/// Entities and their references, as index lists.
struct Graph {
  struct Node {
    std::int64_t id = 0;
    int line = 0;
    std::size_t first = 0, last = 0;  ///< range in refs
    bool owner = false;               ///< says who made something; nothing of the building depends on it
    bool has_owner = false;           ///< its first reference says who made it
  };
  std::vector<Node> nodes;
  std::vector<std::int64_t> refs;  ///< entity numbers; once resolved indices of nodes, or -1 - number of a missing one
};

std::int64_t read_number(std::string_view text, std::size_t& at) {
  std::int64_t value = 0;
  const std::size_t begin = at;
  while (at < text.size() && text[at] >= '0' && text[at] <= '9') {
    if (value > std::numeric_limits<std::int32_t>::max()) return -1;
    value = value * 10 + (text[at++] - '0');
  }
  return at == begin || value > std::numeric_limits<std::int32_t>::max() ? -1 : value;
}

std::size_t skip_spaces(std::string_view text, std::size_t at) {
  while (at < text.size() && std::isspace(static_cast<unsigned char>(text[at])) != 0) ++at;
  return at;
}

/// Collects the references of "(...)" outside strings; false when a '#' has no number.
bool collect_refs(std::string_view text, std::size_t at, std::vector<std::int64_t>& refs) {
  while (at < text.size()) {
    const char c = text[at++];
    if (c == '\'') at = text.find('\'', at) + 1;
    if (c == '#') {
      refs.push_back(read_number(text, at));
      if (refs.back() < 0) return false;
    }
  }
  return true;
}

/// True for the attributes of an IfcRoot: ('22 letters',#owner,
bool has_owner(std::string_view attributes) {
  constexpr std::size_t letters = 22;
  if (!attributes.starts_with("('") || attributes.size() < letters + 4 || attributes[letters + 2] != '\'') return false;
  std::size_t at = skip_spaces(attributes, letters + 3);
  if (at >= attributes.size() || attributes[at] != ',') return false;
  at = skip_spaces(attributes, at + 1);
  return at < attributes.size() && attributes[at] == '#';
}

/// Whether every item of the lists between brackets is a finite number.
bool holds_numbers(std::string_view attributes) {
  std::size_t at = 0;
  while (at < attributes.size()) {
    const std::size_t begin = attributes.find_first_not_of(" \t\r\n(),", at);
    if (begin == std::string_view::npos) return true;
    at = std::min(attributes.find_first_of(" \t\r\n(),", begin), attributes.size());
    std::string_view digits = attributes.substr(begin, at - begin);
    if (digits.front() == '+') digits.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error == std::errc::invalid_argument || end != digits.data() + digits.size() || !std::isfinite(value))
      return false;
  }
  return true;
}

/// A point or direction with something else than numbers, which would be read as zeros.
bool lacks_numbers(std::string_view keyword, std::string_view attributes) {
  return (keyword == "IFCCARTESIANPOINT" || keyword == "IFCDIRECTION") && !holds_numbers(attributes);
}

/// #12 = IFCTHING(...); one that is a point or direction without numbers is as good as missing.
bool read_entity(const Statement& statement, Graph& graph) {
  const std::string_view text = statement.text;
  if (text.empty() || text.front() != '#') return false;
  std::size_t at = 1;
  const std::int64_t id = read_number(text, at);
  at = skip_spaces(text, at);
  if (id <= 0 || at >= text.size() || text[at] != '=') return false;
  at = skip_spaces(text, at + 1);
  const std::size_t keyword = at;
  while (at < text.size() && (std::isalnum(static_cast<unsigned char>(text[at])) != 0 || text[at] == '_')) ++at;
  if (at == keyword) return false;
  const std::string_view name = text.substr(keyword, at - keyword);
  const bool owner = name == "IFCOWNERHISTORY";
  at = skip_spaces(text, at);
  if (at >= text.size() || text[at] != '(' || text.back() != ')') return false;
  if (lacks_numbers(name, text.substr(at))) return true;
  const std::size_t first = graph.refs.size();
  if (!collect_refs(text, at, graph.refs)) return false;
  graph.nodes.push_back({id, statement.line, first, graph.refs.size(), owner, has_owner(text.substr(at))});
  return true;
}

std::string excerpt(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string result;
  for (const char c : text.substr(0, longest)) result += std::isprint(static_cast<unsigned char>(c)) != 0 ? c : '?';
  return "'" + result + (text.size() > longest ? "...'" : "'");
}

/// Schema name of FILE_SCHEMA(('IFC4')), or empty.
std::string schema_of(std::string_view header) {
  const std::size_t begin = header.find('\'');
  const std::size_t end = begin == std::string_view::npos ? begin : header.find('\'', begin + 1);
  if (end == std::string_view::npos) return {};
  std::string name(header.substr(begin + 1, end - begin - 1));
  for (char& c : name) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return name;
}

/// Replaces references by node indices. nodes must be sorted by id.
void resolve(Graph& graph, const std::string& file, StepText& result) {
  for (std::size_t i = 1; i < graph.nodes.size(); ++i) {
    const auto& node = graph.nodes[i];
    if (node.id == graph.nodes[i - 1].id) {
      throw InputError({file, std::max(node.line, graph.nodes[i - 1].line), 0},
                       "#" + std::to_string(node.id) + " is defined twice");
    }
  }
  for (const auto& node : graph.nodes) {
    for (std::size_t r = node.first; r < node.last; ++r) {
      const std::int64_t id = graph.refs[r];
      const auto found = std::lower_bound(graph.nodes.begin(), graph.nodes.end(), id,
                                          [](const Graph::Node& n, std::int64_t v) { return n.id < v; });
      const bool missing = found == graph.nodes.end() || found->id != id;
      if (missing) result.dangling.emplace_back(node.id, id);
      graph.refs[r] = missing ? -1 - id : found - graph.nodes.begin();
    }
  }
}

/// The first missing entity that a node depends on, or 0; that of its children is known.
std::int64_t first_missing(const Graph& graph, const Graph::Node& node, const std::vector<std::int64_t>& missing) {
  if (node.owner) return 0;
  for (std::size_t r = node.first + (node.has_owner ? 1 : 0); r < node.last; ++r) {
    const std::int64_t ref = graph.refs[r];
    const std::int64_t number = ref < 0 ? -1 - ref : missing[static_cast<std::size_t>(ref)];
    if (number != 0) return number;
  }
  return 0;
}

/// Depth-first walk without recursion; throws where references lead in a circle or in too long a row. Returns what
/// missing entity each depends on.
std::vector<std::int64_t> check_acyclic(const Graph& graph, const std::string& file, int chain) {
  constexpr int unseen = -1;
  constexpr int open = -2;
  std::vector<int> depth(graph.nodes.size(), unseen);
  std::vector<std::int64_t> missing(graph.nodes.size(), 0);
  std::vector<std::pair<std::size_t, std::size_t>> stack;
  for (std::size_t root = 0; root < graph.nodes.size(); ++root) {
    if (depth[root] != unseen) continue;
    stack.emplace_back(root, graph.nodes[root].first);
    depth[root] = open;
    while (!stack.empty()) {
      auto& [index, next] = stack.back();
      const Graph::Node& node = graph.nodes[index];
      if (next < node.last) {
        const std::int64_t ref = graph.refs[next++];
        if (ref < 0) continue;
        const auto child = static_cast<std::size_t>(ref);
        if (depth[child] == open) {
          throw InputError({file, node.line, 0}, "#" + std::to_string(node.id) + " refers to itself by way of #" +
                                                     std::to_string(graph.nodes[child].id));
        }
        if (depth[child] == unseen) {
          depth[child] = open;
          stack.emplace_back(child, graph.nodes[child].first);
        }
        continue;
      }
      int deepest = 0;
      for (std::size_t r = node.first; r < node.last; ++r) {
        if (graph.refs[r] >= 0) deepest = std::max(deepest, depth[static_cast<std::size_t>(graph.refs[r])] + 1);
      }
      if (deepest > chain) {
        throw InputError({file, node.line, 0}, "#" + std::to_string(node.id) + " refers through more than " +
                                                   std::to_string(chain) + " entities in a row");
      }
      depth[index] = deepest;
      missing[index] = first_missing(graph, node, missing);
      stack.pop_back();
    }
  }
  return missing;
}

/// Reads HEADER up to its ENDSEC; returns the schema.
std::string read_header(StatementReader& reader, const std::string& file) {
  Statement statement = reader.next();
  if (statement.text != opening_line) {
    throw InputError({file, statement.line, 0},
                     "expected " + std::string(opening_line) + ";, not " + excerpt(statement.text));
  }
  std::string schema;
  while (statement.text != "ENDSEC") {
    statement = reader.next();
    if (statement.text.starts_with("FILE_SCHEMA")) schema = schema_of(statement.text);
    if (statement.text == "DATA") break;
  }
  if (!schema.starts_with("IFC")) {
    throw InputError({file, statement.line, 0},
                     schema.empty() ? "the header names no schema; it should hold FILE_SCHEMA(('IFC4'));"
                                    : "schema " + excerpt(schema) + " is not IFC; IFC2X3 and IFC4 are read");
  }
  return schema;
}

}  // namespace

int StepText::line(std::int64_t step_id) const {
  const auto found = std::lower_bound(line_of.begin(), line_of.end(), std::make_pair(step_id, 0));
  return found == line_of.end() || found->first != step_id ? 0 : found->second;
}

std::int64_t StepText::missing(std::int64_t step_id) const {
  const auto found = std::lower_bound(broken.begin(), broken.end(), std::make_pair(step_id, std::int64_t{0}));
  return found == broken.end() || found->first != step_id ? 0 : found->second;
}

std::string without_comments(std::string_view text) {
  std::string result(without_byte_order_mark(text));
  bool in_string = false;
  std::size_t behind = 0;  // what was last and is no blank
  for (std::size_t at = 0; at < result.size(); ++at) {
    if (result[at] == '\'') in_string = !in_string;
    if (result[at] == ';' && !in_string) {
      std::swap(result[at], result[behind++]);
      continue;
    }
    if (in_string || !std::string_view(result).substr(at).starts_with(comment_begin)) {
      if (std::isspace(static_cast<unsigned char>(result[at])) == 0) behind = at + 1;
      continue;
    }
    const std::size_t found = result.find(comment_end, at + comment_begin.size());
    const bool open = found == std::string::npos;
    const std::size_t end = open ? result.size() : found + comment_end.size();
    if (open) at += comment_begin.size();
    for (; at < end; ++at) {
      if (result[at] != '\n') result[at] = ' ';
    }
    --at;
  }
  return result;
}

StepText check_step_text(std::string_view text, const std::string& file, const StepLimits& limits) {
  StatementReader reader(text, file, limits);
  if (reader.at_end()) {
    throw InputError({file, 0, 0}, "the file is empty; an IFC file begins with " + std::string(opening_line) + ";");
  }
  const std::string_view start = text.substr(skip_spaces(text, 0)).substr(0, opening_line.size());
  if (start.starts_with(comment_begin)) reader.fail_open_comment();
  if (!opening_line.starts_with(start)) {
    reader.fail("not an IFC file: it should begin with " + std::string(opening_line) + ";, not with " + excerpt(start));
  }
  StepText result;
  result.schema = read_header(reader, file);
  Graph graph;
  for (bool in_data = false;;) {
    const Statement statement = reader.next();
    if (statement.text == closing_line) break;
    if (!in_data) {
      in_data = statement.text.starts_with("DATA");
    } else if (statement.text == "ENDSEC") {
      in_data = false;
    } else if (!read_entity(statement, graph)) {
      throw InputError({file, statement.line, 0},
                       "expected an entity such as #1=IFCWALL(...);, not " + excerpt(statement.text));
    }
  }
  std::sort(graph.nodes.begin(), graph.nodes.end(), [](const Graph::Node& a, const Graph::Node& b) {
    return std::make_pair(a.id, a.line) < std::make_pair(b.id, b.line);
  });
  resolve(graph, file, result);
  const std::vector<std::int64_t> missing = check_acyclic(graph, file, limits.chain);
  for (std::size_t i = 0; i < missing.size(); ++i)
    if (missing[i] != 0) result.broken.emplace_back(graph.nodes[i].id, missing[i]);
  result.line_of.reserve(graph.nodes.size());
  for (const auto& node : graph.nodes) result.line_of.emplace_back(node.id, node.line);
  return result;
}

}  // namespace plumbline::bim
