// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace plumbline::scenarios {

/// What an ink of the pages is used for; each use asks for its own contrast [WCAG 2.2, 1.4.3 and 1.4.11].
enum class InkUse {
  ground,   ///< lies under others
  text,     ///< 4.5 against `paper` and `ground`
  graphic,  ///< 3 against `paper` and `room`: a line or an area that means something
  area,     ///< an area whose meaning is written too, where it is pointed at and in a table
  filled,   ///< 4.5 against `on`, the text upon it
  faint     ///< means nothing by itself: grids, edges, furniture
};

/// One colour of the pages, in the light scheme and in the dark one: "#rrggbb".
struct Ink {
  std::string_view name;
  std::string_view light;
  std::string_view dark;
  InkUse use;
  std::string_view on = {};  ///< of `filled`: the ink of the text upon it
};

[[nodiscard]] std::span<const Ink> palette();

/// The palette as custom properties `--NAME` of a style sheet; the browser chooses the scheme.
[[nodiscard]] std::string palette_css();

/// Number of methods that have a colour of their own.
inline constexpr std::size_t method_inks = 12;
/// Colour of the method with this index, as it stands in a page: "var(--m3)".
[[nodiscard]] std::string method_ink(std::size_t method);
/// The same as numbers, for what draws without a style sheet.
[[nodiscard]] const Ink& method_colour(std::size_t method);

}  // namespace plumbline::scenarios
