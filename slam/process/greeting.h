// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "slam/process/process_method.h"

namespace plumbline::slam {

/// HELLO: JSON of protocol, method, seed, X_RL, sensor_height_m, has_odometry, prior, the plan or null, and where there
/// is some, how much shared memory (bytes).
[[nodiscard]] std::string greeting(const ProcessCommand& command, const MethodInput& input, std::size_t shared_memory);

/// What HELLO_OK says.
struct GreetingAnswer {
  bool shared_memory = false;  ///< it reads what stands there
};
/// HELLO_OK: JSON with the protocol that the process speaks. Throws ProcessFailure where it is another one.
[[nodiscard]] GreetingAnswer read_greeting(const std::string& text);
/// Variables of its environment: where the stream is, the seed, one thread in the libraries that ask,
/// and an allocator that keeps the memory of a scan.
[[nodiscard]] std::vector<std::string> environment_of(const MethodInput& input);

}  // namespace plumbline::slam
