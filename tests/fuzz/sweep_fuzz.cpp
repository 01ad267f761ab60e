// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>

#include "bim/errors.h"
#include "scenarios/sweep/sweep_file.h"
#include "tests/folder.h"

namespace {

/// A folder with one scenario, a.yaml, in which sweeps are read.
class Sweeps {
 public:
  Sweeps() { (void)write("a.yaml", "scenario: 1\nbuilding: a.plan.yaml\nstart: {room: a}\nroute: {rooms: all}\n"); }

  [[nodiscard]] std::string write(const char* name, std::string_view text) const {
    const std::string path = folder_ / name;
    if (!(std::ofstream(path, std::ios::binary) << text)) std::abort();
    return path;
  }

 private:
  plumbline::Folder folder_;
};

}  // namespace

/// Any bytes are a sweep, or an InputError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Sweeps sweeps;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    (void)plumbline::scenarios::read_sweep(sweeps.write("sweep.yaml", text), 3);
  } catch (const plumbline::InputError&) {
  }
  return 0;
}
