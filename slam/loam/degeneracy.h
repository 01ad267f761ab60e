// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace plumbline::slam::loam {

/// What a degenerate step may keep [zhang2016].
struct GoodDirections {
  Eigen::MatrixXd projection;  ///< onto the directions that are held
  int degenerate = 0;          ///< directions that are not
};

/// Directions of the symmetric normal matrix whose eigenvalue is at least `least` are held.
[[nodiscard]] GoodDirections good_directions(const Eigen::MatrixXd& normal, double least);

}  // namespace plumbline::slam::loam
