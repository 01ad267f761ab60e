// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <map>
#include <vector>

#include "slam/localization/predicted_scan.h"
#include "slam/plan_map/localization_scan.h"

namespace plumbline::slam {

/// The simplest explanation of an outlier at a hypothesis: a wall or solid that was not built, an object in front of a
/// face, an object where the plan has nothing, or a gap of a railing.
struct OutlierCause {
  enum class Kind { not_built, in_front_of_face, unplanned, between_bars };
  Kind kind = Kind::unplanned;
  int x = 0, y = 0;  ///< element; element and side; cell of HypothesisComparisonConfig::clutter_cell_m in I

  friend auto operator<=>(const OutlierCause&, const OutlierCause&) = default;
};

/// Evidence against a hypothesis, by the cause that would explain it.
class EvidenceByCause {
 public:
  struct Sum {
    double log_likelihood = 0.0;
    double passed = 0.0;         ///< of it, by what passes a wall as a whole
    double unexplained = 0.0;    ///< of beams that end next to `within` and fit at neither pose
    Eigen::AlignedBox2d within;  ///< where beams ended, in I
    double before_m = 0.0;       ///< how far before the face, m, weighted by log_likelihood
    double before_m2 = 0.0;      ///< and its square, m²
    double met = 0.0;            ///< by what meets an element that other beams pass, as if it passed it, too
    Eigen::Vector2d ends = Eigen::Vector2d::Zero();   ///< where beams ended, in I, m, weighted by log_likelihood
    Eigen::Matrix2d ends2 = Eigen::Matrix2d::Zero();  ///< and their outer products, m²
  };
  void add(const OutlierCause& cause, const Sum& more, double scale = 1.0);
  /// passed: the part of it by what passes a wall as a whole.
  void add(const OutlierCause& cause, double log_likelihood, double passed = 0.0) {
    add(cause, {log_likelihood, passed, 0.0, {}});
  }
  void add(const EvidenceByCause& more, double scale);
  void clear() { sums_.clear(); }
  /// No cause counts for more than its cap: an element that was not built, an object that was not planned, or a
  /// railing, which never decides alone. Nor does one wall that is missing as a whole: up to missing_wall_cap and half
  /// of what other causes count for. What stands at one place before several faces, as in a corner, is one object. An
  /// object that ends where the better pose has something end, on all sides, is hardly furniture there by chance and
  /// counts for more. One of which the better pose leaves more than half as much unexplained as it explains counts for
  /// less, and for nothing where it leaves as much: an object stands there at either pose. What may be built-in
  /// furniture, flat and as far before a wall, counts as a wall that is missing does. So does what is as long and
  /// straight as a row of furniture: it may stand by chance where the better pose has a wall.
  [[nodiscard]] double total(const HypothesisComparisonConfig& config) const;

  [[nodiscard]] std::map<OutlierCause, Sum>& sums() { return sums_; }

 private:
  std::map<OutlierCause, Sum> sums_;
};

/// Comparison of two hypotheses by one scan.
struct PairwiseLikelihoodRatio {
  EvidenceByCause against_a, against_b;
  double ratio = 0.0;  ///< log-likelihood ratio of a to b, no cause capped
};
/// Only beams with different predictions count, so that clutter and errors of the plan are no evidence where the two
/// poses look alike. A beam next to an edge of the plan may hit either side of it.
[[nodiscard]] PairwiseLikelihoodRatio compare_hypotheses(const LocalizationScan& scan, const PredictedScan& a,
                                                         const PredictedScan& b,
                                                         const HypothesisComparisonConfig& config);

}  // namespace plumbline::slam
