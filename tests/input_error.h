// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bim/errors.h"

namespace plumbline {

/// What the InputError says that `run` throws; "no error" where it throws none.
template <class Run>
[[nodiscard]] std::string input_error(Run&& run) {
  try {
    run();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace plumbline
