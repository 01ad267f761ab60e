// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace plumbline::slam::mcap {

/// What of a file could not be read.
struct Losses {
  std::size_t chunks = 0;                          ///< of the file
  std::map<std::uint64_t, std::uint64_t> damaged;  ///< chunks of which nothing is read: where they begin, and bytes
  bool unclosed = false;                           ///< the file has no end
  std::uint64_t rest_bytes = 0;                    ///< behind what is whole of such a file
  std::size_t messages_of_cut = 0;                 ///< that are whole in the chunk that such a file ends in

  /// For the user; nothing where the file is whole.
  [[nodiscard]] std::vector<std::string> lines(std::uint64_t file_bytes) const;
};

}  // namespace plumbline::slam::mcap
