// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

namespace plumbline::scenarios {

/// Runs what makes the page of an estimate, whose answer stands without it: where that throws, a warning on stderr says
/// why, about `out`, with files of `folder` by their names. Returns whether the page is made.
[[nodiscard]] bool attempt_page(const std::string& out, const std::string& folder, const std::function<void()>& make);

}  // namespace plumbline::scenarios
