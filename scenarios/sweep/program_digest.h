// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "bim/config/tree.h"

namespace plumbline::scenarios {

/// Digests of what processes start, so that a method that its author has changed is run again: the files that a command
/// names, and the folders of the programs and scripts among them, with what those import. Each folder is read once.
class ProgramDigests {
 public:
  /// Of the processes of a scenario, whose folders are whole paths.
  [[nodiscard]] std::uint64_t of(const Tree& scenario);
  /// Folders of which not all could be taken, a sentence each.
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

 private:
  [[nodiscard]] std::uint64_t of_folder(const std::string& folder);

  std::map<std::string, std::uint64_t> folders_;
  std::vector<std::string> notes_;
};

/// Of this program itself, so that a run made by another build is made again. Read once.
[[nodiscard]] std::uint64_t own_program_digest();

}  // namespace plumbline::scenarios
