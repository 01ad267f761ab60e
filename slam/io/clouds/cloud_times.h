// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "slam/io/records.h"

namespace plumbline::slam {

/// Names of the file that holds the times of a folder's clouds.
inline constexpr std::array<std::string_view, 2> names_of_times = {"times.txt", "timestamps.txt"};

struct CloudTimes {
  std::string file;
  std::vector<Nanoseconds> stamps;  ///< a line each
};

/// A time a line, in seconds or, as KITTI's raw data have it, as date and time of day in UTC: "2011-09-26
/// 13:02:25.594360375". Throws InputError with the line that is neither, or before 0.
[[nodiscard]] std::vector<Nanoseconds> read_cloud_times(std::string_view text, const std::string& file);

/// The times beside the clouds, else those beside their folder, as KITTI has them; nothing where neither is there.
[[nodiscard]] std::optional<CloudTimes> find_cloud_times(const std::string& folder);

/// A stamp for each of the clouds' names: those of the lines, where there are as many, else those of the lines that
/// the names number from 0 on, as 000007.bin, since KITTI's data lack some clouds. Throws InputError where neither is.
[[nodiscard]] std::vector<Nanoseconds> stamps_of(const std::vector<std::string>& names, const CloudTimes& times);

/// The stamps that the names are, as 1700000000.123.pcd or 1700000000123456789.pcd: seconds of this century, or ms, us
/// or ns of it by their 13, 16 or 19 digits. Empty unless all names are, of two clouds and more, each later than the
/// one before.
[[nodiscard]] std::vector<Nanoseconds> stamps_in(const std::vector<std::string>& names);

}  // namespace plumbline::slam
