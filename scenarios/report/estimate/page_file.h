// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenarios/report/estimate/score_file.h"

namespace plumbline::scenarios {

/// report.html of a directory of `plumbline estimate`. altered: files of it that are not as they were written, which
/// the page names; fresh: a score whose files are not yet written. Throws InputError at the file that is missing or
/// damaged.
[[nodiscard]] std::string estimate_page(const std::string& dir, const std::vector<std::string>& altered = {},
                                        const std::optional<NewScore>& fresh = {});

/// Writes it into the directory.
void write_estimate_page(const std::string& dir);

}  // namespace plumbline::scenarios
