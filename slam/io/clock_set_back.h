// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bim/errors.h"
#include "slam/io/records.h"

namespace plumbline::slam {

/// InputError where stamps go back by more than late records do: a clock was set back, and what follows belongs to
/// another recording. stamps: such as "stamps on /imu".
inline void check_not_set_back(Nanoseconds back, const Mark& mark, const std::string& stamps) {
  constexpr Nanoseconds most_back = 1'000'000'000;
  if (back > most_back)
    throw InputError(mark, stamps + " go back by " + std::to_string(back / 1'000'000) +
                               " ms; records that come late by at most " + std::to_string(most_back / 1'000'000) +
                               " ms would be left out");
}

}  // namespace plumbline::slam
