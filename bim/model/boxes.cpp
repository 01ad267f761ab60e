// SPDX-License-Identifier: Apache-2.0
#include "bim/model/boxes.h"

#include "bim/model/wall_face.h"

namespace plumbline::bim {

Eigen::AlignedBox2d box_of(const Polygon2& outline) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : outline) box.extend(p);
  return box;
}

Eigen::AlignedBox3d box_of(const Solid& solid) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : solid.vertices) box.extend(p);
  return box;
}

void BoxIndex::add(const Polygon2& outline) { boxes_.push_back(box_of(outline)); }

std::vector<int> BoxIndex::near(const Polygon2& outline, double margin_m) const {
  Eigen::AlignedBox2d reach = box_of(outline);
  reach.min().array() -= margin_m;
  reach.max().array() += margin_m;
  std::vector<int> indices;
  for (std::size_t i = 0; i < boxes_.size(); ++i)
    if (boxes_[i].intersects(reach)) indices.push_back(static_cast<int>(i));
  return indices;
}

BoxIndex boxes_of(const std::vector<Room>& rooms) {
  BoxIndex boxes;
  for (const Room& room : rooms) boxes.add(room.polygon);
  return boxes;
}

BoxIndex boxes_of(const std::vector<Wall>& walls, std::size_t first) {
  BoxIndex boxes;
  for (std::size_t i = first; i < walls.size(); ++i) boxes.add(footprint(walls[i]));
  return boxes;
}

}  // namespace plumbline::bim
