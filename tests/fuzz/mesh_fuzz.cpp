// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "bim/errors.h"
#include "bim/formats/mesh/mesh_world.h"
#include "bim/mesh/mesh.h"

/// The first byte chooses the format; the rest is a world, which can be meshed, or an InputError. assimp itself runs in
/// a process apart: what it does not survive is an InputError, too.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::array<const char*, 5> endings = {"obj", "dae", "glb", "ply", "stl"};
  if (size == 0) return 0;
  const std::string path = std::string("fuzz.") + endings[data[0] % endings.size()];
  plumbline::bim::MeshWorldConfig config;
  config.file.subprocess.cpu_s = 2;  // below the 10 s of a hang, however loaded the machine
  try {
    (void)plumbline::bim::build_mesh(plumbline::bim::read_mesh_world(
        std::string_view(reinterpret_cast<const char*>(data + 1), size - 1), path, config));
  } catch (const plumbline::InputError&) {
  }
  return 0;
}
