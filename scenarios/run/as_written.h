// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "scenarios/run/record.h"

/// What a method answered as the files of a run hold it, so that scores of a run and of its files are the same.
namespace plumbline::scenarios {

/// To 1 mm; a particle also to 1 mrad and its weight to 1e-6. Throw InternalError on what is not finite.
[[nodiscard]] Eigen::Vector3d rounded(const Eigen::Vector3d& p);
[[nodiscard]] slam::Particle rounded(const slam::Particle& particle);

/// Poses as read back from a trajectory file: quaternions of norm 1, no negative zeros.
void round_as_written(std::vector<slam::StampedPose>& poses);
/// A record as read back from the files of its method: walls and particles rounded, without the graph. Throws
/// InternalError on what those files cannot hold: a value that is not finite.
void round_as_written(MethodRecord& method);
/// Throws InternalError where round_as_written() would of a record with it, or its graph cannot be written.
void check_finite(const BeliefRecord& belief);
void check_finite(const slam::Estimate& estimate);

}  // namespace plumbline::scenarios
