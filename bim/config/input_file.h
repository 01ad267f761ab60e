// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <string>

namespace plumbline {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

/// A file that is open for reading.
struct InputFile {
  std::unique_ptr<std::FILE, CloseFile> stream;
  std::uint64_t bytes = 0;  ///< of a regular file
  bool regular = false;     ///< not of a pipe or device, which end when they end
};

/// Opens a file that a user named; every one is opened here. Throws InputError where it is missing, a directory,
/// unreadable or, by its size alone, larger than `most_bytes`.
[[nodiscard]] InputFile open_input_file(const std::string& path,
                                        std::uint64_t most_bytes = std::numeric_limits<std::uint64_t>::max());

/// Reads a whole file. Throws InputError as open_input_file() does, and where the file is empty.
[[nodiscard]] std::string read_text_file(const std::string& path, std::uint64_t most_bytes = std::uint64_t{1} << 30U);

}  // namespace plumbline
