// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "bim/rays/face.h"

namespace plumbline::bim {

/// Another face that comes so close to a face that a ray may hit both within the tie distance.
struct Contact {
  Eigen::AlignedBox3d region_W;  ///< holds every point of the first face that is that close to the other
  int face = -1;                 ///< the other face
};

/// Contacts of one face: `inside` for those that reach into it (overlapping coplanar faces, crossing walls), `border`
/// for those that touch it in its edge band only (neighbours over an edge).
struct FaceContacts {
  std::vector<Contact> inside;
  std::vector<int> border;
};

/// Contacts of every face, in order of the other face's index. Found once when a scene is built, so that only marked
/// faces pay for ties.
[[nodiscard]] std::vector<FaceContacts> find_contacts(std::span<const Face> faces, const RayTolerances& tolerances);

}  // namespace plumbline::bim
