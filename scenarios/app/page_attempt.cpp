// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/page_attempt.h"

#include <exception>

#include "scenarios/host/terminal.h"

namespace plumbline::scenarios {

bool attempt_page(const std::string& out, const std::string& folder, const std::function<void()>& make) {
  try {
    make();
    return true;
  } catch (const std::exception& error) {
    std::string why = error.what();
    const std::string start = folder + "/";
    for (std::size_t at; (at = why.find(start)) != std::string::npos;) why.erase(at, start.size());
    print_note("plumbline: warning: " + out + ": its page cannot be made: " + why);
    return false;
  }
}

}  // namespace plumbline::scenarios
