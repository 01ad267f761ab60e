// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "bim/errors.h"
#include "scenarios/spec/scenario.h"

/// Any bytes are a scenario, which can be written, or an InputError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    (void)plumbline::scenarios::write_scenario(plumbline::scenarios::read_scenario(text, "fuzz.yaml").scenario);
  } catch (const plumbline::InputError&) {
  }
  return 0;
}
