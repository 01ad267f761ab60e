// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bim/config/tree.h"
#include "scenarios/hunt/hunt.h"

namespace plumbline::scenarios {

/// Folder of finding i, from 0: "failures/01".
[[nodiscard]] std::string folder_of_finding(std::size_t i);
/// hunt.csv: a row for each run and method.
[[nodiscard]] std::string hunt_csv(const Hunt& hunt, const HuntResult& result);
/// hunt.json: the findings.
[[nodiscard]] Tree hunt_results(const Hunt& hunt, const HuntResult& result);
/// Findings with the commands that run and shrink them, what was no method's fault, and bases of which no walk began;
/// lines. `out`: the hunt's
/// folder.
[[nodiscard]] std::string hunt_text(const Hunt& hunt, const HuntResult& result, const std::string& out);

}  // namespace plumbline::scenarios
