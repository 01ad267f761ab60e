// SPDX-License-Identifier: Apache-2.0
#include "bim/config/number_list.h"

namespace plumbline {

Tree number_list(std::initializer_list<double> values) {
  Tree list = Tree::list();
  for (const double v : values) list.push(v);
  return list;
}

Tree number_list(const Eigen::Vector2d& v) { return number_list({v.x(), v.y()}); }

Tree number_list(const Eigen::Vector3d& v) { return number_list({v.x(), v.y(), v.z()}); }

Tree number_list(const Pose& X) { return number_list({X.t.x(), X.t.y(), X.t.z(), X.q.x(), X.q.y(), X.q.z(), X.q.w()}); }

Tree number_list(const Plane& plane) { return number_list({plane.n.x(), plane.n.y(), plane.n.z(), plane.d}); }

}  // namespace plumbline
