// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/hypothesis_history.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenarios/metrics/localization_score.h"

namespace plumbline::scenarios {

namespace {

constexpr double near_m = 0.75, near_rad = 0.35;  // as HypothesisConfig::match_m, match_rad
constexpr double thinned_s = 0.5;                 // below the gap at which a plot's curve is left open
constexpr double thinned_mass = 0.002;            // a fifth of a pixel or so

/// A hypothesis from scan to scan: X_WH = offset * X_WR_true.
struct Tracked {
  Pose offset;
  HypothesisHistory history;
  double most = 0.0;  ///< largest mass it ever had
  int right = 0, seen = 0;
  std::size_t scan = 0;  ///< in which it was seen last
};

double metres(const Pose& a, const Pose& b) { return (a.t - b.t).norm(); }
double radians(const Pose& a, const Pose& b) { return std::abs(wrap_angle(a.yaw() - b.yaw())); }

/// The history nearest to X_WH that no other hypothesis of the scan continues (ties: found first), or a new one.
Tracked& nearest_or_new(std::vector<Tracked>& tracked, std::size_t scan, const Pose& X_WH, const Pose& X_WR_true) {
  Tracked* best = nullptr;
  double least = near_m;
  for (Tracked& one : tracked) {
    const Pose X_WP = one.offset * X_WR_true;
    const double distance = metres(X_WP, X_WH);
    if (one.scan == scan || distance >= least || radians(X_WP, X_WH) > near_rad) continue;
    least = distance;
    best = &one;
  }
  return best != nullptr ? *best : tracked.emplace_back();
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

}  // namespace

std::vector<HypothesisHistory> hypothesis_histories(const std::vector<BeliefRecord>& beliefs, const score::Truth& truth,
                                                    std::size_t most) {
  const score::LocalizationRules rules;
  std::vector<Tracked> tracked;
  for (std::size_t i = 0; i < beliefs.size(); ++i) {
    const Pose X_WR = truth.at(beliefs[i].stamp);
    for (const slam::Hypothesis& hypothesis : beliefs[i].hypotheses) {
      Tracked& one = nearest_or_new(tracked, i + 1, hypothesis.X_WR, X_WR);
      one.scan = i + 1;
      one.offset = hypothesis.X_WR * X_WR.inverse();
      one.most = std::max(one.most, hypothesis.mass);
      ++one.seen;
      if (metres(hypothesis.X_WR, X_WR) <= rules.position_m &&
          radians(hypothesis.X_WR, X_WR) <= rules.yaw_deg * std::numbers::pi / 180.0)
        ++one.right;
      if (one.history.room.empty()) one.history.room = hypothesis.room;
      add(one.history.points, {slam::seconds(beliefs[i].stamp), hypothesis.mass});
    }
  }
  for (Tracked& one : tracked) one.history.is_true = 2 * one.right > one.seen;
  std::stable_sort(tracked.begin(), tracked.end(), [](const Tracked& a, const Tracked& b) {
    return a.history.is_true != b.history.is_true ? a.history.is_true : a.most > b.most;
  });
  if (tracked.size() > most) tracked.resize(most);
  std::vector<HypothesisHistory> histories;
  for (Tracked& one : tracked) histories.push_back(std::move(one.history));
  return histories;
}

}  // namespace plumbline::scenarios
