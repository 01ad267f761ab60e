// SPDX-License-Identifier: Apache-2.0
#include "slam/planes/motion_covariance.h"

#include <algorithm>
#include <cmath>

namespace plumbline::slam {

void add_motion_covariance(std::span<PlaneObservation> planes, const DeskewedScan& scan) {
  const TwistSigma& sigma = scan.twist_sigma;
  if (scan.time_s.empty() || !(sigma.mps > 0.0 || sigma.radps > 0.0)) return;
  const auto [first, last] = std::minmax_element(scan.time_s.begin(), scan.time_s.end());
  // Of a time that lies anywhere in the sweep about the sweep's mean.
  const double time_s = static_cast<double>(*last - *first) / std::sqrt(12.0);
  const double moved_m = sigma.mps * time_s, turned_rad = sigma.radps * time_s;
  for (PlaneObservation& plane : planes) {
    const double bent_m = turned_rad * 0.5 * (plane.p1_R - plane.p0_R).norm();
    const double turned2 = turned_rad * turned_rad;
    plane.covariance += Eigen::Vector3d(turned2, turned2, moved_m * moved_m + bent_m * bent_m).asDiagonal();
  }
}

}  // namespace plumbline::slam
