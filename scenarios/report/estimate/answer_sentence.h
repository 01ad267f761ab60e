// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scenarios/report/estimate/state_spans.h"

namespace plumbline::scenarios {

/// What came out of an estimate, in plain sentences, by what the method itself said: of a localization its state at the
/// end, the room of its answer, when it first announced one, the shares of time of its states; of SLAM the length of
/// its path, the scans it used, what it found; of both when it was lost. `spans` as state_spans() gives them.
[[nodiscard]] std::string answer_sentence(const MethodRecord& method, const std::vector<StateSpan>& spans);

/// The state in which it ended, in a word: "crashed", "no pose", or of the last span.
[[nodiscard]] std::string final_state(const MethodRecord& method, const std::vector<StateSpan>& spans);

}  // namespace plumbline::scenarios
