// SPDX-License-Identifier: Apache-2.0
#include "bim/config/markdown.h"

namespace plumbline {

namespace {

std::string cell(std::string_view text) {
  std::string escaped;
  bool in_code = false;
  for (const char c : text) {
    if (c == '`') in_code = !in_code;
    if (c == '|')
      escaped += "\\|";
    else if (c == '\n')
      escaped += ' ';
    else if (!in_code && (c == '<' || c == '*'))
      escaped += std::string("\\") + c;
    else
      escaped += c;
  }
  return escaped;
}

std::string row(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const std::string& text : cells) line += (text.empty() ? std::string() : " " + cell(text)) + " |";
  return line + "\n";
}

}  // namespace

std::string markdown_code(std::string_view text) { return text.empty() ? "" : "`" + std::string(text) + "`"; }

MarkdownTable::MarkdownTable(const std::vector<std::string>& head) : text_(row(head) + "|") {
  for (std::size_t i = 0; i < head.size(); ++i) text_ += "---|";
  text_ += "\n";
}

void MarkdownTable::add(const std::vector<std::string>& cells) { text_ += row(cells); }

}  // namespace plumbline
