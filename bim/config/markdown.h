// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace plumbline {

/// Text as code; nothing for an empty text.
[[nodiscard]] std::string markdown_code(std::string_view text);

/// A Markdown table. Cells are text of one line or more; what would end a cell or start a tag is escaped.
class MarkdownTable {
 public:
  explicit MarkdownTable(const std::vector<std::string>& head);
  void add(const std::vector<std::string>& cells);
  /// The table, without an empty line after it.
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

}  // namespace plumbline
