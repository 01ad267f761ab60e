// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <bitset>
#include <optional>
#include <span>

#include "slam/scan/motion.h"
#include "slam/scan/plane_observation.h"

namespace plumbline::slam {

[[nodiscard]] bool is_floor(const PlaneObservation& seen);

/// Unit normal in R of the widest floor or ceiling, upwards; of a scan with neither, the direction along all its walls,
/// where those of two directions tell it.
[[nodiscard]] std::optional<Eigen::Vector3d> up_by_planes(std::span<const PlaneObservation> seen);

/// Attitude of R in a frame whose z axis is up by the planes seen, so that walls are vertical in it whatever the gait's
/// phase or the sensor's mount; identity where they do not tell.
[[nodiscard]] Eigen::Quaterniond level_by_planes(std::span<const PlaneObservation> seen);

/// Ten degrees of azimuth in R each.
using SeenDirections = std::bitset<36>;
/// The directions in which returns lie on a plane.
[[nodiscard]] SeenDirections directions_of(const DeskewedScan& scan, const Plane& plane_R);

/// Of the directions with any return, the share in which some lie on a plane.
[[nodiscard]] double share_of_directions(const DeskewedScan& scan, const Plane& plane_R);

/// Whether the robot stands on the lower one of two level planes, as beside a table: in most directions in which the
/// lower one is seen the upper one is not. The ground outdoors is seen through windows, beyond the floor.
[[nodiscard]] bool stands_on_lower(const DeskewedScan& scan, const Plane& lower_R, const Plane& upper_R);

}  // namespace plumbline::slam
