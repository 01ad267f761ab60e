// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/plan_yaml/plan_write.h"

namespace plumbline::bim {

namespace {

bool is_empty(const Tree& tree) {
  if (const auto* text = std::get_if<std::string>(&tree.value)) return text->empty();
  return tree.is_null() || (tree.is_list() && tree.as_list().empty()) || (tree.is_map() && tree.as_map().empty());
}

std::string scalar(const Tree& tree) {
  std::string text = write_yaml(tree);
  text.pop_back();  // its end of line
  return text;
}

/// One line: {key: value, ...}, [value, ...].
std::string flow(const Tree& tree) {
  if (tree.is_scalar()) return scalar(tree);
  std::string text;
  if (tree.is_list()) {
    for (const Tree& item : tree.as_list()) text += (text.empty() ? "" : ", ") + flow(item);
    return "[" + text + "]";
  }
  for (const auto& [key, value] : tree.as_map())
    if (!is_empty(value)) text += (text.empty() ? "" : ", ") + key + ": " + flow(value);
  return "{" + text + "}";
}

bool holds_lines(const Tree& list) {
  return list.is_list() && !list.as_list().empty() && !list.as_list().front().is_scalar();
}

void write_lines(const Tree& list, const std::string& indent, std::string& text) {
  for (const Tree& item : list.as_list()) text += indent + "- " + flow(item) + "\n";
}

}  // namespace

std::string write_plan(const PlanFile& plan, std::string_view comment) {
  std::string text;
  for (std::size_t begin = 0; begin < comment.size();) {
    const std::size_t end = std::min(comment.find('\n', begin), comment.size());
    text += "# " + std::string(comment.substr(begin, end - begin)) + "\n";
    begin = end + 1;
  }
  const Tree tree = to_tree(plan);
  for (const auto& [key, value] : tree.as_map()) {
    if (is_empty(value)) continue;
    if (holds_lines(value)) {
      text += key + ":\n";
      write_lines(value, "  ", text);
    } else if (value.is_map()) {
      text += key + ":\n";
      for (const auto& [inner, child] : value.as_map()) {
        if (is_empty(child)) continue;
        text += "  " + inner + ":" + (holds_lines(child) ? "\n" : " " + flow(child) + "\n");
        if (holds_lines(child)) write_lines(child, "    ", text);
      }
    } else {
      text += key + ": " + flow(value) + "\n";
    }
  }
  return text;
}

}  // namespace plumbline::bim
