// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "slam/io/records.h"

namespace plumbline::scenarios {

/// Digest of what one stage produced at one tick.
struct DigestEntry {
  slam::Nanoseconds tick = 0;
  std::string stage;
  std::uint64_t digest = 0;
};

/// Digests of a run by tick, then pipeline order.
using DigestLog = std::vector<DigestEntry>;

/// Joins logs that are each in time order; within a tick, earlier logs come first.
[[nodiscard]] DigestLog merge_logs(const std::vector<DigestLog>& logs);
/// Digest of the whole log.
[[nodiscard]] std::uint64_t digest_of(const DigestLog& log);

/// Part of the sensor data among those of digests_by_part().
inline constexpr std::string_view sensor_part = "sim";
/// Digest of what each part of a run left: of the sensor data, of all stages of each method.
[[nodiscard]] std::map<std::string, std::uint64_t> digests_by_part(const DigestLog& log);

/// digests.csv: "tick_ns,stage,digest" and a line an entry.
[[nodiscard]] std::string write_digests(const DigestLog& log);
/// Throws InputError naming the line.
[[nodiscard]] DigestLog read_digests(std::string_view text, const std::string& file);

/// The first place where two logs differ.
struct Difference {
  slam::Nanoseconds tick = 0;
  std::string stage;
  std::string what;  ///< "3f… in the first, 9a… in the second" or which of the two ends or lacks the stage
};
[[nodiscard]] std::optional<Difference> first_difference(const DigestLog& a, const DigestLog& b);

}  // namespace plumbline::scenarios
