// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/estimate/state_spans.h"

#include <algorithm>

#include "bim/median.h"
#include "scenarios/metrics/state_names.h"

namespace plumbline::scenarios {

namespace {

/// What a method reported after a scan; empty where it is not known.
std::string state_at(const MethodRecord& method, slam::Nanoseconds stamp) {
  if (!method.localization)
    return std::string(said_lost(method, stamp) ? state_name(slam::State::lost) : followed_state);
  const auto after = std::upper_bound(method.beliefs.begin(), method.beliefs.end(), stamp,
                                      [](slam::Nanoseconds t, const BeliefRecord& belief) { return t < belief.stamp; });
  return after == method.beliefs.begin() ? std::string() : std::string(state_name((after - 1)->state));
}

}  // namespace

std::vector<StateSpan> state_spans(const MethodRecord& method, const std::vector<slam::Nanoseconds>& scans) {
  std::vector<StateSpan> spans;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const double from_s = slam::seconds(scans[i] - scans.front());
    const double to_s = slam::seconds(scans[std::min(i + 1, scans.size() - 1)] - scans.front());
    std::string state = state_at(method, scans[i]);
    if (state.empty()) continue;
    if (!spans.empty() && spans.back().state == state && spans.back().to_s == from_s)
      spans.back().to_s = to_s;
    else
      spans.push_back({from_s, to_s, std::move(state)});
  }
  return spans;
}

double share_of_time(const std::vector<StateSpan>& spans, std::string_view state) {
  double all_s = 0.0, in_state_s = 0.0;
  for (const StateSpan& span : spans) {
    all_s += span.to_s - span.from_s;
    if (span.state == state) in_state_s += span.to_s - span.from_s;
  }
  if (all_s > 0.0) return in_state_s / all_s;
  return !spans.empty() && spans.back().state == state ? 1.0 : 0.0;
}

double usual_interval_s(const std::vector<slam::Nanoseconds>& scans) {
  std::vector<double> intervals_s;
  for (std::size_t i = 1; i < scans.size(); ++i) intervals_s.push_back(slam::seconds(scans[i] - scans[i - 1]));
  return intervals_s.empty() ? 0.0 : upper_median(intervals_s);
}

std::vector<ScanPause> scan_pauses(const std::vector<slam::Nanoseconds>& scans) {
  constexpr double least_s = 1.0, of_usual = 5.0;  // as the warning has it
  const double least = std::max(least_s, of_usual * usual_interval_s(scans));
  std::vector<ScanPause> pauses;
  for (std::size_t i = 1; i < scans.size(); ++i)
    if (slam::seconds(scans[i] - scans[i - 1]) > least)
      pauses.push_back({slam::seconds(scans[i - 1] - scans.front()), slam::seconds(scans[i] - scans.front())});
  std::stable_sort(pauses.begin(), pauses.end(),
                   [](const ScanPause& a, const ScanPause& b) { return a.to_s - a.from_s > b.to_s - b.from_s; });
  return pauses;
}

}  // namespace plumbline::scenarios
