// SPDX-License-Identifier: Apache-2.0
// plumbline_reference DIR: writes the pages of docs/reference into DIR.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "tests/docs/reference.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("Usage: plumbline_reference DIR\n", stderr);
    return 2;
  }
  const std::filesystem::path folder(argv[1]);
  std::filesystem::create_directories(folder);
  for (const plumbline::docs::Page& page : plumbline::docs::reference_pages())
    if (!(std::ofstream(folder / page.file, std::ios::binary) << page.text).flush()) {
      std::fprintf(stderr, "%s: cannot be written\n", (folder / page.file).c_str());
      return 3;
    }
  return 0;
}
