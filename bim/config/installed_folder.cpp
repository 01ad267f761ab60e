// SPDX-License-Identifier: Apache-2.0
#include "bim/config/installed_folder.h"

#include <filesystem>
#include <system_error>

namespace plumbline {

std::string installed_folder(std::initializer_list<const char*> from_program, const char* file) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (error) return {};
  for (const char* path : from_program) {
    const fs::path folder = (program.parent_path() / path).lexically_normal();
    if (fs::exists(folder / file, error)) return folder.string();
  }
  return {};
}

}  // namespace plumbline
