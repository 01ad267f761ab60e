// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace plumbline::scenarios {

struct AlteredRecording {
  std::string folder;
  std::vector<std::string> files;  ///< names in the folder
};

/// Files of a recording that are not as simulate or run --record wrote them, of those that estimate reads. `recording`:
/// as given on the command line. Nothing of one without a manifest, as one from elsewhere is.
[[nodiscard]] AlteredRecording altered_in_recording(const std::string& recording);

}  // namespace plumbline::scenarios
