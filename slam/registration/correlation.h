// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "bim/geometry/pose.h"
#include "slam/registration/surfels.h"
#include "slam/scan/motion.h"
#include "slam/scan/voxel.h"

namespace plumbline::slam {

/// Where the returns of a scan lie, by voxels of 0.3 m in its frame R.
class ReturnVoxels {
 public:
  ReturnVoxels() = default;
  explicit ReturnVoxels(std::span<const Eigen::Vector3d> returns_R);

  [[nodiscard]] bool empty() const { return index_.size() == 0; }
  [[nodiscard]] bool hold(const Eigen::Vector3d& p_R) const;
  /// Whether the point's voxel or one next to it holds a return.
  [[nodiscard]] bool are_near(const Eigen::Vector3d& p_R) const;

 private:
  VoxelIndex index_;
};

/// From where on returns do not count in rooms: turns that are not searched move them.
inline constexpr double correlation_range_m = 30.0;

/// The first return of each such voxel, of those in range.
[[nodiscard]] std::vector<Eigen::Vector3d> thinned_returns(const DeskewedScan& scan, double min_range_m,
                                                           double max_range_m);

/// From below to above in R: the mean normal of the surfels that face R's z by 40 degrees or less, else z.
[[nodiscard]] Eigen::Vector3d up_of(std::span<const Surfel> surfels);

/// Those of thinned returns that stand on the ground: with others above or below, by more than 0.4 m, in a column of
/// 0.6 m. Up is up_of() the scan's surfels.
[[nodiscard]] std::vector<Eigen::Vector3d> standing_returns(std::span<const Eigen::Vector3d> returns_R,
                                                            std::span<const Surfel> surfels);

/// Of degenerate directions, as unit increments (rho in m, phi scaled by a distance), those that move the robot rather
/// than turn it: at most the first two, per metre.
[[nodiscard]] std::vector<Vector6d> movements(std::span<const Vector6d> directions);
/// How many of the directions are left where those movements are known.
[[nodiscard]] int directions_beside(std::span<const Vector6d> directions, std::span<const Vector6d> movements);

/// The way from the keyframe, in its frame, to where most of a scan's returns meet its own, if the sensor turned little
/// meanwhile. Returns count as in correlate(), but the place need not stand out. Nothing where hardly any meet.
[[nodiscard]] std::optional<Eigen::Vector3d> correlation_peak(const ReturnVoxels& keyframe,
                                                              std::span<const Eigen::Vector3d> standing_R,
                                                              const Eigen::Vector3d& p_RL,
                                                              std::span<const Vector6d> movements, double window_m);

/// Correlative scan matching [olson2009] in directions that nothing else measures. Of the places that one or two
/// movements lead to from X_KR, increments from the right, each by up to window_m, the one at which most of a scan's
/// standing returns fall into voxels of an earlier keyframe K. Returns that would be near to K's if the sensor, at p_RL
/// in R, had only turned do not count: those of a bare wall go along with it.
/// Nothing where no place stands out, or the one that does is less than 0.9 m from K or at the edge of the window.
[[nodiscard]] std::optional<Pose> correlate(const ReturnVoxels& keyframe, std::span<const Eigen::Vector3d> standing_R,
                                            const Pose& X_KR, const Eigen::Vector3d& p_RL,
                                            std::span<const Vector6d> movements, double window_m);

}  // namespace plumbline::slam
