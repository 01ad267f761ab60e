// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace plumbline::bim {

/// Limits of what a STEP file may hold before a recursive reader could run out of stack.
struct StepLimits {
  int nesting = 64;  ///< brackets within one entity; IFC itself needs 3
  int chain = 1000;  ///< entities that refer to each other in a row; real files stay below 40
};

/// Result of one pass over a STEP file (ISO 10303-21): its schema and where each entity stands.
struct StepText {
  std::string schema;                                 ///< first name of FILE_SCHEMA, upper case, such as IFC2X3
  std::vector<std::pair<std::int64_t, int>> line_of;  ///< (entity number, line of its '#'), ascending
  std::vector<std::pair<std::int64_t, std::int64_t>> dangling;  ///< (entity, the number it refers to without an entity)
  /// Entities that depend on such a reference, not counting who owns them, each with the missing number; ascending.
  std::vector<std::pair<std::int64_t, std::int64_t>> broken;

  /// Line of an entity, or 0 when the file has none of that number.
  [[nodiscard]] int line(std::int64_t step_id) const;
  /// The missing entity that an entity depends on, or 0.
  [[nodiscard]] std::int64_t missing(std::int64_t step_id) const;
};

/// The text with comments and a byte-order mark blanked out, and with semicolons right behind what they end; entities
/// stay in their lines. Of a comment that does not end its beginning stays, which check_step_text() refuses.
[[nodiscard]] std::string without_comments(std::string_view text);

/// Checks that the text is a whole, well-formed STEP file whose references never lead in a circle, so that the library
/// that reads it next meets no surprise; lists those that lead nowhere. The text has no comments. Throws InputError
/// with file and line otherwise.
[[nodiscard]] StepText check_step_text(std::string_view text, const std::string& file, const StepLimits& limits = {});

}  // namespace plumbline::bim
