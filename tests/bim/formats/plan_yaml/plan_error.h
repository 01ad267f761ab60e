// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bim/errors.h"
#include "bim/formats/plan_yaml/plan_yaml.h"

namespace plumbline::bim {

/// What reading a plan of this text complains of.
[[nodiscard]] inline std::string error_of(const std::string& text) {
  try {
    (void)read_plan_text(text, "p.yaml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace plumbline::bim
