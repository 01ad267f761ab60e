// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <ostream>

// The entries of tests/fuzz/*_fuzz.cpp, renamed by the build.
extern "C" {
int fuzz_ifc(const std::uint8_t* data, std::size_t size);
int fuzz_plan(const std::uint8_t* data, std::size_t size);
int fuzz_traffic_editor(const std::uint8_t* data, std::size_t size);
int fuzz_mesh(const std::uint8_t* data, std::size_t size);
int fuzz_scenario(const std::uint8_t* data, std::size_t size);
int fuzz_sweep(const std::uint8_t* data, std::size_t size);
int fuzz_recording(const std::uint8_t* data, std::size_t size);
int fuzz_cloud(const std::uint8_t* data, std::size_t size);
int fuzz_bag(const std::uint8_t* data, std::size_t size);
}

namespace plumbline {

/// Reads bytes as inputs of its kind: returns 0, also where it refuses them, or throws.
struct MalformedReader {
  const char* name;
  int (*read)(const std::uint8_t* data, std::size_t size);
  int variants;  ///< a second of them, about
};

inline std::ostream& operator<<(std::ostream& out, const MalformedReader& reader) { return out << reader.name; }

inline constexpr std::array<MalformedReader, 9> malformed_readers = {{{"ifc", fuzz_ifc, 200},
                                                                      {"plan", fuzz_plan, 500},
                                                                      {"traffic_editor", fuzz_traffic_editor, 500},
                                                                      {"mesh", fuzz_mesh, 100},
                                                                      {"scenario", fuzz_scenario, 1000},
                                                                      {"sweep", fuzz_sweep, 1000},
                                                                      {"recording", fuzz_recording, 1666},
                                                                      {"cloud", fuzz_cloud, 1000},
                                                                      {"bag", fuzz_bag, 1000}}};

}  // namespace plumbline
