// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "slam/localization/compare_hypotheses.h"

namespace plumbline::slam {

namespace {

/// An object that was not planned, whatever it stands before.
struct UnplannedObject {
  double log_likelihood = 0.0;  ///< each cause's up to its cap
  double length_m = 0.0;        ///< of what beams ended at
  double front = 0.0;           ///< of sum, what is like the front of a row of cupboards, or as long and straight
  EvidenceByCause::Sum sum;     ///< not capped
};

/// Share of other causes by which a missing wall counts for more than alone.
constexpr double corroborated = 0.5;

/// Most of what contradicts the element passes it as a whole, and does not only end in it; and hardly anything meets
/// it.
bool is_missing_wall(const EvidenceByCause::Sum& sum, const HypothesisComparisonConfig& config) {
  return sum.passed > 0.5 * sum.log_likelihood && sum.met <= config.met_share * sum.passed;
}

bool is_outlined(const EvidenceByCause::Sum& sum, const HypothesisComparisonConfig& config) {
  return sum.unexplained <= config.outline_share * sum.log_likelihood;
}

/// Flat, and as far before a face as the front of a row of cupboards is: one coincidence puts all of it where another
/// pose has a wall, however long it is.
bool is_flat(const OutlierCause& cause, const EvidenceByCause::Sum& sum, const HypothesisComparisonConfig& config) {
  if (cause.kind != OutlierCause::Kind::in_front_of_face || sum.log_likelihood <= 0.0) return false;
  const double mean_m = sum.before_m / sum.log_likelihood;
  const double variance = sum.before_m2 / sum.log_likelihood - mean_m * mean_m;
  return mean_m >= config.front_depth_min_m && mean_m <= config.front_depth_max_m &&
         variance <= config.front_sigma_m * config.front_sigma_m;
}

/// Where beams ended lies along one line, as a wall would.
bool is_straight(const EvidenceByCause::Sum& sum, const HypothesisComparisonConfig& config) {
  const Eigen::Vector2d mean = sum.ends / sum.log_likelihood;
  const Eigen::Matrix2d scatter = sum.ends2 / sum.log_likelihood - mean * mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(scatter, Eigen::EigenvaluesOnly);
  return axes.eigenvalues()(0) <= config.front_sigma_m * config.front_sigma_m;
}

/// The ends of a front are seen before the walls beside it, too. Its parts before several faces are straight together;
/// with what stands beside it they are not.
bool is_front(const UnplannedObject& object, const HypothesisComparisonConfig& config) {
  if (object.length_m <= config.object_m) return false;
  return object.front > 0.5 * object.sum.log_likelihood || is_straight(object.sum, config);
}

/// 1 until the better pose leaves half as much of the object unexplained as it explains, down to 0 where it leaves as
/// much: then one stands there at either pose.
double explained_share(const EvidenceByCause::Sum& sum) {
  return std::clamp(2.0 - 2.0 * sum.unexplained / sum.log_likelihood, 0.0, 1.0);
}

/// Most that an object counts for.
double cap_of(const UnplannedObject& object, const HypothesisComparisonConfig& config) {
  const double cap = explained_share(object.sum) * std::max(1.0, object.length_m / config.object_m) * config.object_cap;
  const bool outlined = object.length_m <= config.object_m && is_outlined(object.sum, config);
  return outlined ? std::max(cap, config.outlined_cap) : cap;
}

/// Joins objects nearer than the gap, until none are.
void join_near(std::vector<UnplannedObject>& objects, const HypothesisComparisonConfig& config) {
  for (std::size_t i = 0; i < objects.size();) {
    std::size_t k = i + 1;
    while (k < objects.size() && objects[i].sum.within.exteriorDistance(objects[k].sum.within) > config.object_gap_m)
      ++k;
    if (k == objects.size()) {
      ++i;
      continue;
    }
    objects[i].log_likelihood += objects[k].log_likelihood;
    objects[i].front += objects[k].front;
    objects[i].sum.log_likelihood += objects[k].sum.log_likelihood;
    objects[i].sum.unexplained += objects[k].sum.unexplained;
    objects[i].sum.within.extend(objects[k].sum.within);
    objects[i].sum.ends += objects[k].sum.ends;
    objects[i].sum.ends2 += objects[k].sum.ends2;
    // A small one may be seen before several faces, one beside the other.
    const double across_m = objects[i].sum.within.diagonal().norm();
    objects[i].length_m = across_m <= config.object_m ? across_m : objects[i].length_m + objects[k].length_m;
    objects.erase(objects.begin() + static_cast<std::ptrdiff_t>(k));
    i = 0;
  }
}

}  // namespace

void EvidenceByCause::add(const OutlierCause& cause, const Sum& more, double scale) {
  Sum& sum = sums_[cause];
  sum.log_likelihood += scale * more.log_likelihood;
  sum.passed += scale * more.passed;
  sum.unexplained += scale * more.unexplained;
  sum.met += scale * more.met;
  sum.before_m += scale * more.before_m;
  sum.before_m2 += scale * more.before_m2;
  sum.within.extend(more.within);
  sum.ends += scale * more.ends;
  sum.ends2 += scale * more.ends2;
}

void EvidenceByCause::add(const EvidenceByCause& more, double scale) {
  for (const auto& [cause, sum] : more.sums_) add(cause, sum, scale);
}

double EvidenceByCause::total(const HypothesisComparisonConfig& config) const {
  double total = 0.0, fronts = 0.0, missing_wall = 0.0;  // the largest wall
  std::vector<UnplannedObject> objects;
  for (const auto& [cause, sum] : sums_) {
    if (cause.kind == OutlierCause::Kind::not_built) {
      const double capped = std::min(sum.log_likelihood, config.cause_cap);
      total += capped;
      if (is_missing_wall(sum, config)) missing_wall = std::max(missing_wall, capped);
    } else if (cause.kind == OutlierCause::Kind::between_bars || sum.within.isEmpty())
      total += std::min(sum.log_likelihood, config.object_cap);
    else {
      const double length_m = sum.within.diagonal().norm();
      const bool front = is_flat(cause, sum, config) || (length_m > config.object_m && is_straight(sum, config));
      UnplannedObject object{0.0, length_m, front ? sum.log_likelihood : 0.0, sum};
      object.log_likelihood =
          std::min(sum.log_likelihood, is_outlined(sum, config) ? config.outlined_cap : config.object_cap);
      objects.push_back(object);
    }
  }
  join_near(objects, config);
  for (const UnplannedObject& object : objects)
    (is_front(object, config) ? fronts : total) += std::min(object.log_likelihood, cap_of(object, config));
  const double others = total - missing_wall;
  const double front = std::min(fronts, config.front_cap + corroborated * total);
  return others + front + std::min(missing_wall, config.missing_wall_cap + corroborated * (others + front));
}

}  // namespace plumbline::slam
