// SPDX-License-Identifier: Apache-2.0
#include "slam/process/client_folder.h"

#include <filesystem>
#include <system_error>

namespace plumbline::slam {

std::string client_folder() {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (error) return {};
  for (const char* from_program :
       {"../share/plumbline/client", "../../slam/process/client", "../../../slam/process/client"}) {
    const fs::path folder = (program.parent_path() / from_program).lexically_normal();
    if (fs::exists(folder / "plumbline_client.py", error)) return folder.string();
  }
  return {};
}

}  // namespace plumbline::slam
