// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace plumbline::scenarios::score {

/// A value of results.json that is a word, and what it says.
struct ResultWord {
  std::string_view key;  ///< of the method's block
  std::string word;
  std::string_view doc;  ///< one sentence without its full stop
};

/// Every verdict, evidence and cause of failure, those of one key together.
[[nodiscard]] std::span<const ResultWord> result_words();

}  // namespace plumbline::scenarios::score
