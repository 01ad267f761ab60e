// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenarios/run/record.h"

namespace plumbline::scenarios {

/// A time over which a method reported one state.
struct StateSpan {
  double from_s = 0.0, to_s = 0.0;  ///< since the first scan
  std::string state;                ///< as state_name(); of SLAM that was not lost "followed"
};

inline constexpr std::string_view followed_state = "followed";

/// The states of a method over the scans, which stand in time order; each holds until the next scan, the last one for
/// no time.
[[nodiscard]] std::vector<StateSpan> state_spans(const MethodRecord& method,
                                                 const std::vector<slam::Nanoseconds>& scans);

/// Share of the time in a state, in [0, 1]; of one scan alone, 1 for its state.
[[nodiscard]] double share_of_time(const std::vector<StateSpan>& spans, std::string_view state);

/// A pause between two scans, from the first scan on, s.
struct ScanPause {
  double from_s = 0.0, to_s = 0.0;
};

/// Times without scans of more than a second and of more than five usual intervals, the longest first (ties: the
/// earlier).
[[nodiscard]] std::vector<ScanPause> scan_pauses(const std::vector<slam::Nanoseconds>& scans);

/// The usual time from scan to scan, s: the upper median; 0 of fewer than two scans.
[[nodiscard]] double usual_interval_s(const std::vector<slam::Nanoseconds>& scans);

}  // namespace plumbline::scenarios
