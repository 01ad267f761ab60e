// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scenarios/report/estimate/estimate_page.h"

namespace plumbline::scenarios {

/// Reads a directory of `plumbline estimate` for its page: the same whether it has just been written or stands for
/// long. Throws InputError at the file that is missing or damaged.
[[nodiscard]] EstimatePage read_estimate_page(const std::string& dir);

/// Files of the directory that a command makes of the others, which are not compared with its manifest.
[[nodiscard]] std::vector<std::string> made_of_an_estimate();

/// Writes report.html into the directory. altered: files of it that are not as they were written, which the page names.
void write_estimate_page(const std::string& dir, const std::vector<std::string>& altered = {});

}  // namespace plumbline::scenarios
