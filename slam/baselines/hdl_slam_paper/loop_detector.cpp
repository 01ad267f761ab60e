// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/hdl_slam_paper/loop_detector.h"

#include "slam/loop/fitness.h"

namespace plumbline::slam::hdl {

std::vector<std::size_t> loop_candidates(const std::vector<LoopKeyframe>& keyframes, double last_loop_m,
                                         const LoopDetectorConfig& config) {
  std::vector<std::size_t> candidates;
  const LoopKeyframe& now = keyframes.back();
  if (now.walked_m - last_loop_m < config.since_last_m) return candidates;
  for (std::size_t k = 0; k + 1 < keyframes.size(); ++k) {
    if (now.walked_m - keyframes[k].walked_m < config.walked_m) continue;
    if ((keyframes[k].X_MR.t - now.X_MR.t).head<2>().norm() <= config.distance_m) candidates.push_back(k);
  }
  return candidates;
}

std::optional<HdlLoop> detect_loop(const std::vector<LoopKeyframe>& keyframes, double last_loop_m,
                                   const LoopDetectorConfig& config, CloudMatcher& matcher) {
  const std::vector<std::size_t> candidates = loop_candidates(keyframes, last_loop_m, config);
  const LoopKeyframe& now = keyframes.back();
  if (candidates.empty() || now.points_R->empty()) return std::nullopt;
  std::optional<HdlLoop> best;
  matcher.set_target(*now.points_R);
  for (const std::size_t k : candidates) {
    const LoopKeyframe& old = keyframes[k];
    if (old.points_R->empty()) continue;
    Pose guess = now.X_MR.inverse() * old.X_MR;
    guess.t.z() = 0.0;
    const CloudMatch match = matcher.match(*old.points_R, guess);
    if (!match.converged) continue;
    const double fit = fitness(*now.points_R, *old.points_R, match.X_TS);
    if (!best || fit < best->fitness_m2) best = HdlLoop{k, match.X_TS.inverse(), fit};
  }
  if (best && best->fitness_m2 > config.fitness_m2) best.reset();
  return best;
}

}  // namespace plumbline::slam::hdl
