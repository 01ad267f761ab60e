// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace plumbline::slam {

/// Files of a folder by which a rosbag2 is told that has no metadata.yaml.
struct BagFiles {
  std::vector<std::string> names;  ///< .db3 or .mcap, in order; empty where the folder holds no bag, or several
  std::string several;             ///< "'a.db3' and 'b.db3'", two that are of different bags; else empty
  std::string missing;             ///< the first file whose number is skipped; else empty
};

/// One file is a bag, and so are several whose names differ by a running number: walk_0.db3, walk_1.db3. A folder with
/// metadata.yaml or recording.yaml says itself what it is, and gives none.
[[nodiscard]] BagFiles find_bag_files(const std::string& folder);

}  // namespace plumbline::slam
