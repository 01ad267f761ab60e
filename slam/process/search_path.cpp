// SPDX-License-Identifier: Apache-2.0
#include "slam/process/search_path.h"

#include <cstdlib>
#include <sstream>

namespace plumbline::slam {

std::vector<std::string> search_path(const std::string& here) {
  const char* path = std::getenv("PATH");
  std::istringstream list(path == nullptr ? "/bin:/usr/bin" : path);
  std::vector<std::string> folders;
  for (std::string one; std::getline(list, one, ':');) folders.push_back(one.empty() ? here : one);
  return folders;
}

}  // namespace plumbline::slam
