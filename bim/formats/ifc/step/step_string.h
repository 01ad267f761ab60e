// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace plumbline::bim {

/// UTF-8 as a STEP string with its quotes [iso2016]: ' and \ doubled, everything that is not printable ASCII as
/// \X2\ or \X4\ groups. A byte that is no UTF-8 becomes U+FFFD.
[[nodiscard]] std::string step_string(std::string_view utf8);

/// What stands between the quotes of a STEP string, as UTF-8. Knows '', \\, \X\, \X2\, \X4\ and \S\; what is no escape
/// stays as it is.
[[nodiscard]] std::string text_of_step(std::string_view quoted);

/// A number with the decimal point that STEP asks for, in the shortest form that reads back to the same double. Throws
/// InternalError on not-a-number and infinity.
[[nodiscard]] std::string step_real(double value);

}  // namespace plumbline::bim
