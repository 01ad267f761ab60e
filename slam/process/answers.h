// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "slam/io/estimate.h"

namespace plumbline::slam {

/// Payload of an OUTPUT. Throws ProcessFailure where it is not one for the scan of this time: wrong length or time, a
/// pose that is none, masses that are no shares.
[[nodiscard]] Output read_output(std::span<const std::byte> payload, Nanoseconds stamp, bool localization);
/// Payload of an ESTIMATE. strict: bytes that are reserved are refused, else passed over. Throws ProcessFailure.
[[nodiscard]] Estimate read_estimate(std::span<const std::byte> payload, bool localization, bool strict = false);

}  // namespace plumbline::slam
