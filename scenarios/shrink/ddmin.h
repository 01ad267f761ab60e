// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace plumbline::scenarios {

/// Indices of what stays, ascending.
using Kept = std::vector<std::size_t>;
/// Candidates, each made when it is asked for: all together would take the square of the parts.
struct KeptCandidates {
  std::size_t count = 0;
  std::function<Kept(std::size_t)> at;
};
/// The first of some candidates that still fails, if one does.
struct FirstFailure {
  std::optional<std::size_t> index;
  bool no_try_left = false;  ///< those after the last one tried are not known
};
using FirstFailing = std::function<FirstFailure(const KeptCandidates&)>;

/// Delta debugging [zeller2002] on `count` parts, of which all together fail: parts that still fail, such that with any
/// one of them left out they do not, as long as tries last. Parts are left out in chunks, all of them first, then
/// halves, quarters and so on, so that few of many are found in few tries. No candidate is asked for that is not
/// smaller than what fails so far.
[[nodiscard]] Kept minimize(std::size_t count, const FirstFailing& first_failing);

}  // namespace plumbline::scenarios
