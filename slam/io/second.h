// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/io/records.h"

namespace plumbline::slam {

inline constexpr Nanoseconds second_ns = 1'000'000'000;

}  // namespace plumbline::slam
