// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace plumbline::bim {

/// The id with the lowest number behind it, from 2 on, that no element has.
template <class Element>
[[nodiscard]] std::string unused_id(const std::string& id, const std::vector<Element>& some,
                                    const std::vector<Element>& more) {
  for (int number = 2;; ++number) {
    std::string candidate = id + "-" + std::to_string(number);
    const auto same = [&](const Element& element) { return element.id == candidate; };
    if (std::none_of(some.begin(), some.end(), same) && std::none_of(more.begin(), more.end(), same)) return candidate;
  }
}

}  // namespace plumbline::bim
