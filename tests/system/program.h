// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tests/data.h"
#include "tests/folder.h"

namespace plumbline::system_tests {

/// How the program is started.
struct Setting {
  std::string cwd;                                        ///< empty: that of the test
  std::map<std::string, std::optional<std::string>> env;  ///< set, or removed where there is no value
  bool close_stdin = false;
  bool one_cpu = false;                     ///< allow one CPU only
  std::optional<std::size_t> largest_file;  ///< bytes any file may have (RLIMIT_FSIZE)
  std::vector<std::string> wrapper;         ///< command that starts the program, such as an emulator
  std::function<bool()> kill_when;          ///< asked every 10 ms; then `signal` is sent once
  int signal = 0;
};

struct Outcome {
  int code = -1;    ///< exit code, or 128 + signal
  std::string out;  ///< stdout
  std::string err;  ///< stderr
};

/// Runs $PLUMBLINE_BINARY with these arguments.
[[nodiscard]] Outcome plumbline(const std::vector<std::string>& arguments, const Setting& setting = {});

/// True when the program and the project's files are known to this test.
[[nodiscard]] bool available();
[[nodiscard]] std::string read_file(const std::string& path);
void write_file(const std::string& path, const std::string& text);

}  // namespace plumbline::system_tests
