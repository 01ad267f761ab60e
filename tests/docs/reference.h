// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace plumbline::docs {

/// A page of docs/reference.
struct Page {
  std::string file;
  std::string text;
};

/// Every page of docs/reference as this build of the program describes itself, with the page that lists them.
[[nodiscard]] std::vector<Page> reference_pages();

}  // namespace plumbline::docs
