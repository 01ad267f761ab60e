// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bim/errors.h"
#include "slam/io/estimate.h"

namespace plumbline::slam {

/// Seconds with nine decimals.
[[nodiscard]] std::string format_stamp(Nanoseconds stamp);
/// Reads one line. Throws InputError at the mark on another number of columns, text that is no number, or a quaternion
/// that is no rotation.
[[nodiscard]] StampedPose parse_tum_line(std::string_view line, const Mark& mark);
/// Reads decimal seconds, to the nanosecond. False where the text is no number or 4e9 s or more from 0.
[[nodiscard]] bool parse_stamp(std::string_view text, Nanoseconds& stamp);
/// Reads a finite number that is all of the text.
[[nodiscard]] bool parse_number(std::string_view text, double& value);
/// TUM text: "t tx ty tz qx qy qz qw" a line, one space between, numbers that read back to the same bits.
[[nodiscard]] std::string write_tum(const std::vector<StampedPose>& poses);
/// Reads TUM text; lines starting with # and empty lines are skipped. Throws InputError naming the line on another
/// number of columns, text that is no number, a quaternion that is no rotation, or stamps out of order.
[[nodiscard]] std::vector<StampedPose> read_tum(std::string_view text, const std::string& file);

}  // namespace plumbline::slam
