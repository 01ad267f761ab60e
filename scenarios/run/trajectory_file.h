// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "slam/io/estimate.h"

namespace plumbline::scenarios {

/// Seconds with nine decimals.
[[nodiscard]] std::string format_stamp(slam::Nanoseconds stamp);
/// TUM text: "t tx ty tz qx qy qz qw" a line, one space between, numbers that read back to the same bits.
[[nodiscard]] std::string write_tum(const std::vector<slam::StampedPose>& poses);
/// Reads TUM text; lines starting with # and empty lines are skipped. Throws InputError naming the line on another
/// number of columns, text that is no number, a quaternion that is no rotation, or stamps out of order.
[[nodiscard]] std::vector<slam::StampedPose> read_tum(std::string_view text, const std::string& file);

}  // namespace plumbline::scenarios
