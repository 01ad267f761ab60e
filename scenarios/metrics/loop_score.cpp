// SPDX-License-Identifier: Apache-2.0
#include "scenarios/metrics/loop_score.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bim/geometry/pose.h"

namespace plumbline::scenarios::score {

namespace {

/// A place on the way.
struct Place {
  double walked_m = 0.0;
  Eigen::Vector3d p_W;
};

std::vector<Place> places_of(const Truth& truth, const LoopRules& rules) {
  const std::vector<double> walked = truth.walked();
  std::vector<Place> places;
  for (std::size_t i = 0; i < walked.size(); ++i)
    if (places.empty() || walked[i] - places.back().walked_m >= rules.sample_m)
      places.push_back({walked[i], truth.at(truth.scans[i]).t});
  return places;
}

bool was_there_before(const std::vector<Place>& places, std::size_t i, const LoopRules& rules) {
  for (std::size_t k = 0; k < i && places[i].walked_m - places[k].walked_m >= rules.min_walked_m; ++k) {
    const Eigen::Vector3d off = places[i].p_W - places[k].p_W;
    if (off.head<2>().norm() <= rules.revisit_m && std::abs(off.z()) <= rules.level_m) return true;
  }
  return false;
}

/// Distance walked until t.
double walked_until(const Truth& truth, const std::vector<double>& walked, slam::Nanoseconds t) {
  const auto it = std::upper_bound(truth.scans.begin(), truth.scans.end(), t);
  return it == truth.scans.begin() ? 0.0 : walked[static_cast<std::size_t>(it - truth.scans.begin()) - 1];
}

bool is_right(const slam::LoopEdge& loop, const Truth& truth, const LoopRules& rules) {
  const Pose error = loop.X_FT.inverse() * (truth.at(loop.from).inverse() * truth.at(loop.to));
  return error.t.norm() <= rules.max_error_m &&
         log_so3(error.q).norm() <= rules.max_error_deg * std::numbers::pi / 180.0;
}

}  // namespace

std::vector<Revisit> revisits(const Truth& truth, const LoopRules& rules) {
  const std::vector<Place> places = places_of(truth, rules);
  std::vector<Revisit> pieces;
  bool open = false;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!was_there_before(places, i, rules)) {
      open = false;
      continue;
    }
    if (!open || places[i].walked_m - pieces.back().from_m > rules.piece_m)
      pieces.push_back({places[i].walked_m, places[i].walked_m});
    pieces.back().to_m = places[i].walked_m;
    open = true;
  }
  std::erase_if(pieces, [&](const Revisit& piece) { return piece.to_m - piece.from_m < rules.min_piece_m; });
  return pieces;
}

LoopScore score_loops(const std::vector<slam::LoopEdge>& loops, const Truth& truth, const LoopRules& rules) {
  const std::vector<double> walked = truth.walked();
  const std::vector<Revisit> pieces = revisits(truth, rules);
  std::vector<bool> closed(pieces.size(), false);
  LoopScore score;
  score.found = static_cast<int>(loops.size());
  score.revisits = static_cast<int>(pieces.size());
  for (const slam::LoopEdge& loop : loops) {
    if (!is_right(loop, truth, rules)) continue;
    ++score.right;
    const double end_m = walked_until(truth, walked, std::max(loop.from, loop.to));
    for (std::size_t k = 0; k < pieces.size(); ++k)
      if (end_m >= pieces[k].from_m && end_m <= pieces[k].to_m + rules.sample_m) closed[k] = true;
  }
  score.closed = static_cast<int>(std::count(closed.begin(), closed.end(), true));
  if (score.found > 0) score.precision = static_cast<double>(score.right) / score.found;
  if (score.revisits > 0) score.recall = static_cast<double>(score.closed) / score.revisits;
  return score;
}

}  // namespace plumbline::scenarios::score
