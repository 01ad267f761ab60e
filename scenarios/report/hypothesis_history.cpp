// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/hypothesis_history.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "scenarios/host/interrupt.h"
#include "scenarios/metrics/localization_score.h"

namespace plumbline::scenarios {

namespace {

constexpr double near_m = 0.75, near_rad = 0.35;  // as HypothesisConfig::match_m, match_rad
constexpr double thinned_s = 0.5;                 // below the gap at which a plot's curve is left open
constexpr double thinned_mass = 0.002;            // a fifth of a pixel or so
constexpr std::size_t most_of_a_scan = 500;       // the heaviest; of the others the page tells the sum
constexpr std::size_t most_tracked = 2000;        // over all scans

/// A hypothesis from scan to scan: X_WH = offset * X_WR_true.
struct Tracked {
  Pose offset;
  std::string room;
  std::vector<HypothesisHistory> stretches;
  double mass = 0.0;                 ///< over all scans
  std::vector<Eigen::Vector2d> all;  ///< (time in s, mass), at each of its scans
  bool was_true = false;             ///< at some scan
  std::size_t scan = 0;              ///< in which it was seen last
};

double metres(const Pose& a, const Pose& b) { return (a.t - b.t).norm(); }
double radians(const Pose& a, const Pose& b) { return std::abs(wrap_angle(a.yaw() - b.yaw())); }

/// Where each history would be at this scan, had the robot moved as it did.
std::vector<Pose> predicted(const std::vector<Tracked>& tracked, const Pose& X_WR_true) {
  std::vector<Pose> X_WP;
  X_WP.reserve(tracked.size());
  for (const Tracked& one : tracked) X_WP.push_back(one.offset * X_WR_true);
  return X_WP;
}

/// The history nearest to X_WH that no other hypothesis of the scan continues (ties: found first), or a new one; null
/// where there are too many. X_WP: of those that were there before the scan.
Tracked* nearest_or_new(std::vector<Tracked>& tracked, std::size_t scan, const Pose& X_WH,
                        const std::vector<Pose>& X_WP) {
  Tracked* best = nullptr;
  double least = near_m;
  for (std::size_t k = 0; k < X_WP.size(); ++k) {
    const double distance = metres(X_WP[k], X_WH);
    if (tracked[k].scan == scan || distance >= least || radians(X_WP[k], X_WH) > near_rad) continue;
    least = distance;
    best = &tracked[k];
  }
  if (best != nullptr) return best;
  return tracked.size() < most_tracked ? &tracked.emplace_back() : nullptr;
}

/// Which hypotheses of a scan are followed, in their order: all, or the heaviest (ties: the first).
std::vector<bool> followed(const std::vector<slam::Hypothesis>& hypotheses) {
  std::vector<std::size_t> order(hypotheses.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return hypotheses[a].mass > hypotheses[b].mass; });
  std::vector<bool> of(hypotheses.size(), false);
  for (std::size_t k = 0; k < std::min(most_of_a_scan, order.size()); ++k) of[order[k]] = true;
  return of;
}

/// Keeps what a line needs: the points where the mass changes, and one every so often.
void add(std::vector<Eigen::Vector2d>& points, const Eigen::Vector2d& point) {
  const bool changes = points.size() < 2 ||
                       std::abs(points.back().y() - points[points.size() - 2].y()) > thinned_mass ||
                       std::abs(point.y() - points.back().y()) > thinned_mass;
  if (changes || point.x() - points[points.size() - 2].x() > thinned_s)
    points.push_back(point);
  else
    points.back() = point;
}

/// The stretch that goes on, or a new one that starts where the last one ended.
HypothesisHistory& stretch_of(Tracked& one, bool is_true) {
  if (!one.stretches.empty() && one.stretches.back().is_true == is_true) return one.stretches.back();
  HypothesisHistory next;
  next.is_true = is_true;
  if (!one.stretches.empty()) next.points.push_back(one.stretches.back().points.back());
  return one.stretches.emplace_back(std::move(next));
}

}  // namespace

HypothesisHistories hypothesis_histories(const std::vector<BeliefRecord>& beliefs, const score::Truth& truth,
                                         std::size_t most, bool judged) {
  const score::LocalizationRules rules;
  std::vector<Tracked> tracked;
  std::map<double, double> others;  // mass by time
  std::size_t not_followed = 0;     // of the scan that had most of them
  for (std::size_t i = 0; i < beliefs.size(); ++i) {
    check_interrupt();
    const Pose X_WR = truth.at(beliefs[i].stamp);
    const std::vector<Pose> X_WP = predicted(tracked, X_WR);
    const std::vector<bool> is_followed = followed(beliefs[i].hypotheses);
    std::size_t passed_over = 0;
    for (std::size_t k = 0; k < is_followed.size(); ++k) {
      const slam::Hypothesis& hypothesis = beliefs[i].hypotheses[k];
      Tracked* found = is_followed[k] ? nearest_or_new(tracked, i + 1, hypothesis.X_WR, X_WP) : nullptr;
      if (found == nullptr) {
        others[slam::seconds(beliefs[i].stamp)] += hypothesis.mass;
        ++passed_over;
        continue;
      }
      Tracked& one = *found;
      one.scan = i + 1;
      one.offset = hypothesis.X_WR * X_WR.inverse();
      one.mass += hypothesis.mass;
      one.all.emplace_back(slam::seconds(beliefs[i].stamp), hypothesis.mass);
      if (one.room.empty()) one.room = hypothesis.room;
      const bool is_true = judged && metres(hypothesis.X_WR, X_WR) <= rules.position_m &&
                           radians(hypothesis.X_WR, X_WR) <= rules.yaw_deg * std::numbers::pi / 180.0;
      one.was_true = one.was_true || is_true;
      add(stretch_of(one, is_true).points, {slam::seconds(beliefs[i].stamp), hypothesis.mass});
    }
    not_followed = std::max(not_followed, passed_over);
  }
  std::stable_sort(tracked.begin(), tracked.end(), [](const Tracked& a, const Tracked& b) {
    return a.was_true != b.was_true ? a.was_true : a.mass > b.mass;
  });
  HypothesisHistories histories;
  histories.left_out = not_followed;
  for (std::size_t k = most; k < tracked.size(); ++k, ++histories.left_out)
    for (const Eigen::Vector2d& p : tracked[k].all) others[p.x()] += p.y();
  for (const auto& [t_s, mass] : others) histories.others.emplace_back(t_s, mass);
  for (std::size_t k = 0; k < std::min(most, tracked.size()); ++k)
    for (HypothesisHistory& stretch : tracked[k].stretches) {
      stretch.hypothesis = static_cast<int>(k);
      stretch.room = tracked[k].room;
      histories.shown.push_back(std::move(stretch));
    }
  return histories;
}

}  // namespace plumbline::scenarios
