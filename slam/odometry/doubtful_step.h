// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "slam/registration/vgicp.h"

namespace plumbline::slam {

/// A step that may lead to an alias of the place, and what later scans tell of it. Scans that fit the local map of
/// before the step, and would fit it clearly less after another step, as the one that was expected, show that it led
/// there. What was mapped since the step moves with it, and shows nothing.
class DoubtfulStep {
 public:
  /// What was known at a doubtful scan.
  struct Scan {
    Pose X_MR_before;      ///< at the scan before
    Pose found, expected;  ///< steps from there
    double usual_matched;  ///< share of a scan's features, see OdometryHealth
    double usual_residual_m;
    double sure_share = 1;  ///< of usual_matched, from which on a match is no alias
  };

  /// matcher: matched that scan last, and has not yet committed it.
  DoubtfulStep(const VgicpOdometry& matcher, const Scan& scan);

  /// Another doubtful scan, likewise. What confirmed the step until there is void.
  void add_doubtful(const Scan& scan);
  /// A later scan, which the matcher matched at X_MR and has not yet committed. expected: it was accepted after an
  /// expected step.
  void add(const VgicpOdometry& matcher, const Pose& X_MR, bool expected);
  /// Whether enough scans in a row, each from another place, showed that the step led to where it was found.
  [[nodiscard]] bool is_settled() const;

 private:
  /// Whether the scan fits the map of before there ...
  [[nodiscard]] bool fits(const Registration& here, const Pose& X_MR) const;
  /// ... and nowhere else that another step may have led to.
  [[nodiscard]] bool fits_elsewhere(const VgicpOdometry& matcher, const Registration& here, const Pose& X_MR) const;

  std::vector<SurfelMap> before_;
  std::vector<Scan> scans_;   ///< doubtful ones
  int confirmed_ = 0;         ///< views in a row
  std::optional<Pose> X_MR_;  ///< of the last of them
};

}  // namespace plumbline::slam
