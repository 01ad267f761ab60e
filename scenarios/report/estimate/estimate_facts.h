// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "bim/config/tree.h"
#include "slam/io/records.h"

namespace plumbline::scenarios {

/// What estimate.yaml says of an estimate, in words. Each part is empty where an earlier version did not write it.
struct EstimateFacts {
  std::string recording;                                   ///< name without its folders
  std::string command;                                     ///< that makes the estimate again
  std::vector<std::pair<std::string, std::string>> given;  ///< what it was made of: heading, value
  std::vector<std::string> warnings;                       ///< a sentence each
  std::vector<std::string> unchecked;                      ///< files of the recording that had been altered
  std::string config;                                      ///< all values of the method, YAML
  slam::Nanoseconds origin = 0;  ///< time 0 of digests.csv on the recording's clock; 0: not written
};

/// Throws InputError on what estimate.yaml cannot hold.
[[nodiscard]] EstimateFacts estimate_facts(const Tree& estimate);

}  // namespace plumbline::scenarios
