// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/estimate/thinned_path.h"

#include <algorithm>
#include <cmath>

#include "bim/median.h"

namespace plumbline::scenarios {

namespace {

constexpr std::size_t most_samples = 5000;

/// Whether sample i is another one's neighbour with which something begins or ends.
bool is_at_change(const std::vector<ReportSample>& samples, std::size_t i) {
  const auto differs = [&](std::size_t other) {
    return samples[i].lost != samples[other].lost || samples[i].storey != samples[other].storey;
  };
  return (i > 0 && differs(i - 1)) || (i + 1 < samples.size() && differs(i + 1));
}

}  // namespace

std::size_t drawn_one_in(std::size_t samples) {
  return std::max<std::size_t>(1, (samples + most_samples - 1) / most_samples);
}

std::vector<ReportSample> thinned_path(const std::vector<ReportSample>& samples, std::size_t every) {
  std::vector<ReportSample> kept;
  std::size_t changes = 0;
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (i % every == 0 || i + 1 == samples.size() || (is_at_change(samples, i) && ++changes <= most_samples))
      kept.push_back(samples[i]);
  return kept;
}

PathBreaks breaks_of(const std::vector<ReportSample>& samples, std::size_t every) {
  constexpr double of_usual = 5.0;
  std::vector<double> steps_s, steps_m;
  for (std::size_t i = every; i < samples.size(); i += every) {
    const ReportSample &from = samples[i - every], &to = samples[i];
    steps_s.push_back(to.t_s - from.t_s);
    steps_m.push_back(std::hypot(to.x - from.x, to.y - from.y));
  }
  PathBreaks breaks;
  if (steps_m.empty()) return breaks;
  return {std::max(breaks.gap_s, of_usual * upper_median(steps_s)),
          std::max(breaks.jump_m, of_usual * upper_median(steps_m))};
}

}  // namespace plumbline::scenarios
