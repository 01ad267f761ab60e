// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace plumbline::scenarios {

/// The page's style sheet and script, as they stand in the page.
[[nodiscard]] std::string_view page_style();
[[nodiscard]] std::string_view page_script();

}  // namespace plumbline::scenarios
