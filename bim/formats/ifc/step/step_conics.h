// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "bim/formats/ifc/step/step_entities.h"

namespace plumbline::bim {

/// The numbers of a list of two or three as a point; z 0 where there are two.
[[nodiscard]] Eigen::Vector3d step_point(const StepValue& list);
/// Where an IfcCartesianPoint lies.
[[nodiscard]] Eigen::Vector3d cartesian_point(const StepEntities& entities, const StepValue& reference);

/// An IfcCircle or IfcEllipse.
struct StepConic {
  Eigen::Affine3d X = Eigen::Affine3d::Identity();  ///< frame: x along the first radius
  double rx = 0.0, ry = 0.0;
  bool flat = false;  ///< placed in two dimensions

  [[nodiscard]] double angle_of(const Eigen::Vector3d& p) const;
  [[nodiscard]] Eigen::Vector3d at(double angle) const;
};

/// Nullopt for entities of other types and such as make no sense.
[[nodiscard]] std::optional<StepConic> conic_of(const StepEntities& entities, const StepEntities::Entity& entity);

/// How deep a piece may cut into its arc, m. A LiDAR's noise hides it, also where IFC++ makes a piece or two less.
inline constexpr double arc_depth_m = 1.5e-3;

/// How many pieces stand for an arc of an angle: one for each 10 degrees, two at least; more where they would cut
/// deeper than `depth`, which is in the unit of the radius, but at most two for each degree. Throws InputError where
/// angle or radius is no number.
[[nodiscard]] int arc_pieces(double angle, double radius, double depth);

/// From the point first to the point last on the conic; a whole turn where they are the same. Forward is
/// counter-clockwise about its z axis.
[[nodiscard]] std::vector<Eigen::Vector3d> arc_between(const StepConic& conic, const Eigen::Vector3d& first,
                                                       const Eigen::Vector3d& last, bool forward, double depth);

}  // namespace plumbline::bim
