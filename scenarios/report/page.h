// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace plumbline::scenarios {

/// The page's style sheet and script, as they stand in the page.
[[nodiscard]] std::string_view page_style();
[[nodiscard]] std::string_view page_script();
/// Lets a click on a heading sort its table: by number where the column holds numbers.
[[nodiscard]] std::string_view sort_script();
/// What maps of any page do: zoom, pan, names that keep their size and stay apart. Stands before page_script().
[[nodiscard]] std::string_view map_script();

}  // namespace plumbline::scenarios
