// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "slam/process/process_method.h"

namespace plumbline::slam {

/// HELLO: JSON of protocol, method, seed, X_RL, sensor_height_m, has_odometry, prior, config, and the plan or null.
[[nodiscard]] std::string greeting(const ProcessCommand& command, const MethodInput& input);
/// HELLO_OK: JSON with the protocol that the process speaks. Throws ProcessFailure where it is another one.
void check_greeting(const std::string& text);
/// Variables of its environment: where the stream is, the seed, one thread in the libraries that ask.
[[nodiscard]] std::vector<std::string> environment_of(const MethodInput& input);

}  // namespace plumbline::slam
