// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/outside_gate.h"

#include <charconv>
#include <cmath>

#include "bim/config/tree.h"
#include "bim/config/words.h"
#include "bim/errors.h"

namespace plumbline::scenarios {

GateSpec parse_gate(const std::string& text) {
  const Mark mark{"--gate", 0, 0};
  std::size_t sign = text.find("<=");
  const bool at_most = sign != std::string::npos;
  if (!at_most) sign = text.find(">=");
  if (sign == std::string::npos || without_blanks(text.substr(0, sign)).empty())
    throw InputError(mark, "'" + text + "' must be METRIC<=X or METRIC>=X, in quotes, as 'ate_aligned_rmse_m<=0.05'");
  const std::string number(without_blanks(text.substr(sign + 2)));
  double limit = 0.0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), limit);
  constexpr double most = 1e9;
  if (error != std::errc() || end != number.data() + number.size() || !(std::abs(limit) <= most))
    throw InputError(mark, "'" + number + "' in '" + text + "' must be a number from -1e9 to 1e9");
  GateSpec gate;
  gate.metric = without_blanks(text.substr(0, sign));
  (at_most ? gate.max : gate.min) = limit;
  return gate;
}

}  // namespace plumbline::scenarios
