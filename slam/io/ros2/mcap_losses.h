// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bim/errors.h"

namespace plumbline::slam::mcap {

/// What of a file could not be read.
class Losses {
 public:
  std::size_t chunks = 0;                          ///< of the file
  std::map<std::uint64_t, std::uint64_t> damaged;  ///< chunks of which nothing is read: where they begin, and bytes
  bool any_whole = false;                          ///< chunk that was read
  bool unclosed = false;                           ///< the file has no end
  std::uint64_t rest_bytes = 0;                    ///< behind what is whole of such a file
  std::size_t messages_of_cut = 0;                 ///< that are whole in the chunk that such a file ends in

  void add_damaged(std::uint64_t at, std::uint64_t bytes, const InputError& why);
  /// Throws what was wrong with the first damaged chunk where no chunk that was read is whole.
  void refuse_if_all_is_damaged() const;
  /// For the user; nothing where the file is whole.
  [[nodiscard]] std::vector<std::string> lines(std::uint64_t file_bytes) const;

 private:
  std::optional<InputError> first_damage_;
};

}  // namespace plumbline::slam::mcap
