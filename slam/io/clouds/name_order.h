// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace plumbline::slam {

/// Order of file names by the numbers in them: 7.pcd before 10.pcd; digits behind a decimal point, as of a stamp, by
/// their places. Of two names, one of which begins as the other, the shorter is the earlier. A strict weak order.
[[nodiscard]] inline bool is_earlier_name(std::string_view a, std::string_view b) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const auto digits_at = [&](std::string_view name, std::size_t i) {
    std::size_t end = i;
    while (end < name.size() && is_digit(name[end])) ++end;
    return name.substr(i, end - i);
  };
  const auto without_zeros = [](std::string_view digits) {
    return digits.substr(std::min(digits.find_first_not_of('0'), digits.size()));
  };
  std::size_t i = 0, k = 0;
  while (i < a.size() && k < b.size()) {
    if (!is_digit(a[i]) || !is_digit(b[k])) {
      if (a[i] != b[k]) return a[i] < b[k];
      ++i, ++k;
      continue;
    }
    const bool is_fraction = i > 1 && a[i - 1] == '.' && is_digit(a[i - 2]);
    const std::string_view of_a = digits_at(a, i), of_b = digits_at(b, k);
    const std::string_view number_a = is_fraction ? of_a : without_zeros(of_a);
    const std::string_view number_b = is_fraction ? of_b : without_zeros(of_b);
    if (!is_fraction && number_a.size() != number_b.size()) return number_a.size() < number_b.size();
    if (number_a != number_b) return number_a < number_b;
    i += of_a.size();
    k += of_b.size();
  }
  if (i < a.size() || k < b.size()) return k < b.size();
  return a < b;  // they differ in leading zeros alone
}

}  // namespace plumbline::slam
