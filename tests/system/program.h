// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

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
/// Absolute path of a file of the project.
[[nodiscard]] std::string project_file(const std::string& name);
[[nodiscard]] std::string read_file(const std::string& path);
void write_file(const std::string& path, const std::string& text);

/// A new folder that goes away with this.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] std::string operator/(const std::string& name) const { return path_ + "/" + name; }
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace plumbline::system_tests
