// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace plumbline::scenarios {

/// What every verdict, state and metric of a report means, as a part of its page.
[[nodiscard]] std::string glossary();

}  // namespace plumbline::scenarios
