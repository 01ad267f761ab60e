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

/// A place from scan to scan: X_WH = offset * X_WR_true.
struct Place {
  Pose offset;
  ReportTrack track;
  double most = 0.0;  ///< largest mass it ever had
  int right = 0, seen = 0;
  std::size_t scan = 0;  ///< in which it was seen last
};

double metres(const Pose& a, const Pose& b) { return (a.t - b.t).norm(); }
double radians(const Pose& a, const Pose& b) { return std::abs(wrap_angle(a.yaw() - b.yaw())); }

/// The place nearest to X_WH that no other hypothesis of the scan is (ties: found first), or a new one.
Place& place_of(std::vector<Place>& places, std::size_t scan, const Pose& X_WH, const Pose& X_WR_true) {
  Place* best = nullptr;
  double least = near_m;
  for (Place& place : places) {
    const Pose X_WP = place.offset * X_WR_true;
    const double distance = metres(X_WP, X_WH);
    if (place.scan == scan || distance >= least || radians(X_WP, X_WH) > near_rad) continue;
    least = distance;
    best = &place;
  }
  return best != nullptr ? *best : places.emplace_back();
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

std::vector<ReportTrack> hypothesis_tracks(const std::vector<BeliefRecord>& beliefs, const score::Truth& truth,
                                           std::size_t most) {
  const score::LocalizationRules rules;
  std::vector<Place> places;
  for (std::size_t i = 0; i < beliefs.size(); ++i) {
    const Pose X_WR = truth.at(beliefs[i].stamp);
    for (const slam::Hypothesis& hypothesis : beliefs[i].hypotheses) {
      Place& place = place_of(places, i + 1, hypothesis.X_WR, X_WR);
      place.scan = i + 1;
      place.offset = hypothesis.X_WR * X_WR.inverse();
      place.most = std::max(place.most, hypothesis.mass);
      ++place.seen;
      if (metres(hypothesis.X_WR, X_WR) <= rules.position_m &&
          radians(hypothesis.X_WR, X_WR) <= rules.yaw_deg * std::numbers::pi / 180.0)
        ++place.right;
      if (place.track.room.empty()) place.track.room = hypothesis.room;
      add(place.track.points, {slam::seconds(beliefs[i].stamp), hypothesis.mass});
    }
  }
  for (Place& place : places) place.track.is_true = 2 * place.right > place.seen;
  std::stable_sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    return a.track.is_true != b.track.is_true ? a.track.is_true : a.most > b.most;
  });
  if (places.size() > most) places.resize(most);
  std::vector<ReportTrack> tracks;
  for (Place& place : places) tracks.push_back(std::move(place.track));
  return tracks;
}

}  // namespace plumbline::scenarios
