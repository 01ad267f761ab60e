// SPDX-License-Identifier: Apache-2.0
#include <stdlib.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "bim/errors.h"
#include "scenarios/sweep/sweep_file.h"

namespace {

/// A folder with one scenario, a.yaml, in which sweeps are read.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "plumbline_fuzz_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) std::abort();
    path_ = name;
    (void)write("a.yaml", "scenario: 1\nbuilding: a.plan.yaml\nstart: {room: a}\nroute: {rooms: all}\n");
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] std::string write(const char* name, std::string_view text) const {
    const std::string path = path_ + "/" + name;
    if (!(std::ofstream(path, std::ios::binary) << text)) std::abort();
    return path;
  }

 private:
  std::string path_;
};

}  // namespace

/// Any bytes are a sweep, or an InputError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    (void)plumbline::scenarios::read_sweep(folder.write("sweep.yaml", text), 3);
  } catch (const plumbline::InputError&) {
  }
  return 0;
}
