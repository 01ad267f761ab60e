// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "scenarios/report/estimate/estimate_page.h"
#include "scenarios/report/estimate/score_file.h"

namespace plumbline::scenarios {

/// Reads a directory of `plumbline estimate` for its page: the same whether it has just been written or stands for
/// long. fresh: in place of the files of a score. Throws InputError at the file that is missing or damaged.
[[nodiscard]] EstimatePage read_estimate_page(const std::string& dir, const std::optional<NewScore>& fresh = {});

}  // namespace plumbline::scenarios
