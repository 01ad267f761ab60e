// SPDX-License-Identifier: Apache-2.0
#include "scenarios/metrics/silence.h"

#include <algorithm>
#include <utility>

namespace plumbline::scenarios::score {

namespace {

/// The first span that is not over at t; the end where all are.
std::vector<LostSpan>::const_iterator span_from(const std::vector<LostSpan>& lost, slam::Nanoseconds t) {
  return std::find_if(lost.begin(), lost.end(), [&](const LostSpan& span) { return span.to >= t; });
}

/// A pose and how far off it was.
struct Sample {
  slam::Nanoseconds stamp = 0;
  double error_m = 0.0;
};

/// Of every causal pose that has a true one.
std::vector<Sample> errors_of(const std::vector<slam::StampedPose>& reference_W,
                              const std::vector<slam::StampedPose>& causal_F, const ReferenceRules& rules) {
  // The other way round than scores by a reference do: at the stamps of the estimate, which are those of its word.
  std::vector<PosePair> pairs = match_reference(causal_F, reference_W, rules);
  for (PosePair& pair : pairs) std::swap(pair.X_FR, pair.X_WR);
  std::vector<Sample> samples;
  if (pairs.empty()) return samples;
  const Pose X_WF = place_by_first(pairs);
  for (const PosePair& pair : pairs)
    samples.push_back({causal_F[pair.scan].stamp, (X_WF * pair.X_FR.t - pair.X_WR.t).norm()});
  return samples;
}

/// Longest time in a row in which the error was too great and the method not lost, ns.
slam::Nanoseconds longest_silence(const std::vector<Sample>& samples, const std::vector<LostSpan>& lost,
                                  double most_error_m) {
  slam::Nanoseconds longest = 0;
  std::optional<slam::Nanoseconds> since;
  for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
    const slam::Nanoseconds t = samples[i].stamp;
    const auto span = span_from(lost, t);
    const bool is_lost = span != lost.end() && span->from <= t;
    if (!(samples[i].error_m > most_error_m) || is_lost) {
      since.reset();
      continue;
    }
    if (!since) since = t;
    const slam::Nanoseconds next = samples[i + 1].stamp;
    const bool said = span != lost.end() && span->from < next;  // after a scan without a pose
    longest = std::max(longest, (said ? span->from : next) - *since);
    if (said) since.reset();
  }
  return longest;
}

}  // namespace

std::optional<Silence> score_silence(const std::vector<slam::StampedPose>& reference_W,
                                     const std::vector<slam::StampedPose>& causal_F, const std::vector<LostSpan>& lost,
                                     const SilenceRules& rules) {
  if (reference_W.empty() || causal_F.empty()) return std::nullopt;
  const std::vector<Sample> samples = errors_of(reference_W, causal_F, rules.reference);
  if (samples.empty()) return std::nullopt;
  Silence silence;
  silence.silent_s = slam::seconds(longest_silence(samples, lost, rules.most_error_m));
  const auto off =
      std::find_if(samples.begin(), samples.end(), [&](const Sample& s) { return s.error_m > rules.most_error_m; });
  if (off == samples.end()) return silence;
  silence.off_at_s = slam::seconds(off->stamp - causal_F.front().stamp);
  if (const auto span = span_from(lost, off->stamp); span != lost.end())
    silence.said_after_s = slam::seconds(std::max<slam::Nanoseconds>(span->from - off->stamp, 0));
  return silence;
}

}  // namespace plumbline::scenarios::score
