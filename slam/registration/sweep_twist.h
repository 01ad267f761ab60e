// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "slam/registration/registration.h"
#include "slam/scan/motion.h"

namespace plumbline::slam {

/// The robot's motion during a scan beyond what deskewing undid, per second, (rho, phi) in R: where its surfels fit the
/// map best together with the pose at the scan's stamp, both free [dellenbach2022]. A motion that was measured between
/// scans only, or not at all, is that of a mean over the interval; a hand sways within it. `sigma` is its prior,
/// `prior` that of the pose. Directions that surfaces leave open at X_MR keep their prior. Zero where nothing can be
/// found.
[[nodiscard]] Vector6d sweep_twist(std::span<const Surfel> surfels, std::span<const SurfelMap> maps, const Pose& X_MR,
                                   const std::optional<PosePrior>& prior, const TwistSigma& sigma,
                                   std::span<const RegistrationConfig> configs);

}  // namespace plumbline::slam
