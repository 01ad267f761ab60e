// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bim/rays/scene.h"
#include "scenarios/identify/constants.h"

namespace plumbline::scenarios {

/// The levelled, noise-free scan of a place: elevations x azimuths, index elevation * azimuths + azimuth.
struct View {
  std::vector<double> range_m;            ///< infinity: nothing hit
  std::vector<Eigen::Vector3d> normal_W;  ///< of the face hit
};

/// Casts views and compares them. Directions are fixed tables in the levelled sensor frame.
class Viewer {
 public:
  explicit Viewer(int azimuths = identify_constants.azimuths);
  [[nodiscard]] View look(const bim::RayScene& scene, const Eigen::Vector3d& position_W, double yaw) const;
  /// Negative log-likelihood of seeing `seen` where `expected` is predicted; beams of `seen` shifted by `shift`
  /// azimuth steps (a view from the same place turned by that many steps).
  [[nodiscard]] double cost(const View& seen, const View& expected, int shift = 0) const;
  [[nodiscard]] const std::vector<Eigen::Vector3d>& directions() const { return directions_; }

 private:
  int azimuths_;
  std::vector<Eigen::Vector3d> directions_;
};

}  // namespace plumbline::scenarios
