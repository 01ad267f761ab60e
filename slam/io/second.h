// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "slam/io/records.h"

namespace plumbline::slam {

inline constexpr Nanoseconds second_ns = 1'000'000'000;
/// Times are nearer to 1970 than this, 126 years, either way, so that no difference of two overflows.
inline constexpr Nanoseconds furthest_stamp = 4'000'000'000'000'000'000;
/// Velodyne packets count the time within an hour.
inline constexpr std::int64_t hour_us = 3'600'000'000;

}  // namespace plumbline::slam
