// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace plumbline::scenarios {

/// Indices of what stays, ascending.
using Kept = std::vector<std::size_t>;
/// The first of these candidates that still fails; nothing where none does or no try is left.
using FirstFailing = std::function<std::optional<std::size_t>(const std::vector<Kept>&)>;

/// Delta debugging [zeller2002] on `count` parts, of which all together fail: parts that still fail, such that with any
/// one of them left out they do not, as long as tries last. Parts are left out in chunks, all of them first, then
/// halves, quarters and so on, so that few of many are found in few tries. No candidate is asked for that is not
/// smaller than what fails so far.
[[nodiscard]] Kept minimize(std::size_t count, const FirstFailing& first_failing);

}  // namespace plumbline::scenarios
