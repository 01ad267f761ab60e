// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace plumbline::scenarios {

/// Everything before the heading of a page, up to and with <main>: policy (no network), title, palette, style sheet.
/// `title` is plain text.
[[nodiscard]] std::string open_page(const std::string& title);

/// Files of the folder page/, embedded by CMake; see page/embed.cmake.
[[nodiscard]] std::string_view page_style();
/// Time line, plots and layers of the report.
[[nodiscard]] std::string_view page_script();
/// Lets a click on a heading sort its table: by number where the column holds numbers.
[[nodiscard]] std::string_view sort_script();
/// What maps of any page do: zoom, pan, names that keep their size and stay apart, coordinates. Stands before
/// page_script().
[[nodiscard]] std::string_view map_script();
/// What the page of an estimate has beside the report's: lines as wide on the screen whatever the map's size, and where
/// the robot is at the time shown.
[[nodiscard]] std::string_view estimate_style();
[[nodiscard]] std::string_view estimate_script();
/// Buttons with data-copy: put that text on the clipboard, or select it where they may not.
[[nodiscard]] std::string_view copy_script();

}  // namespace plumbline::scenarios
