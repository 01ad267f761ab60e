// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "bim/errors.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/mesh/mesh.h"

/// Any bytes are a building, which can be meshed, or an InputError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    (void)plumbline::bim::build_mesh(plumbline::bim::read_plan_with_deviations(text, "fuzz.yaml").as_built.building);
  } catch (const plumbline::InputError&) {
  }
  return 0;
}
