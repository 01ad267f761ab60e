// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/read/wall_box.h"

#include <algorithm>
#include <cmath>

#include "bim/model/wall_frame.h"

namespace plumbline::bim {

WallBox box_in(const Wall& wall, const std::vector<Solid>& solids) {
  const WallFrame frame(wall);
  WallBox box;
  for (const Solid& solid : solids) {
    for (const Eigen::Vector3d& p_W : solid.vertices) {
      const Eigen::Vector3d p = frame.to_wall(p_W);
      box.along.add(p.x());
      box.across.add(p.y());
      box.height.add(p.z());
    }
  }
  return box;
}

WallBox box_within(const Wall& wall, const std::vector<Solid>& solids) {
  const WallFrame frame(wall);
  const Interval thickness{wall.offset_m, wall.offset_m + wall.thickness_m};
  WallBox box;
  const auto add = [&](const Eigen::Vector3d& p) {
    box.along.add(p.x());
    box.across.add(p.y());
    box.height.add(p.z());
  };
  for (const Solid& solid : solids) {
    const std::vector<Eigen::Vector3d> points = frame.to_wall(solid.vertices);
    for (const Eigen::Vector3i& t : solid.triangles)
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d& p = points[static_cast<std::size_t>(t[k])];
        const Eigen::Vector3d& q = points[static_cast<std::size_t>(t[(k + 1) % 3])];
        if (p.y() >= thickness.low && p.y() <= thickness.high) add(p);
        for (const double y : {thickness.low, thickness.high})
          if ((p.y() < y) != (q.y() < y)) add(p + (y - p.y()) / (q.y() - p.y()) * (q - p));
      }
  }
  return box.along.length() >= 0.0 ? box : box_in(wall, solids);
}

double overlap(const Interval& a, const Interval& b) { return std::max(0.0, -gap(a, b)); }

double common_area(const WallBox& a, const WallBox& b, double slack_m) {
  if (overlap({a.across.low - slack_m, a.across.high + slack_m}, b.across) <= 0.0) return 0.0;
  return overlap(a.along, b.along) * overlap(a.height, b.height);
}

WallBox said_box(const StepProduct& filling, const Wall& wall, const std::vector<Solid>& bodies) {
  constexpr double least_share = 0.5, rounding_m = 0.05, parallel = 0.99;
  const WallBox body = box_in(wall, bodies);
  const auto fits = [&](double said_m, const Interval& range) {
    return said_m <= range.length() + rounding_m && said_m >= least_share * range.length();
  };
  if (!fits(filling.width_m, body.along) || !fits(filling.height_m, body.height)) return body;
  const Eigen::Vector3d corner = WallFrame(wall).to_wall(filling.X_WP.translation());
  const double turn = filling.X_WP.linear().col(0).head<2>().dot(wall.direction());
  const double far = corner.x() + (turn < 0.0 ? -filling.width_m : filling.width_m);
  WallBox said = body;
  said.along = {std::min(corner.x(), far), std::max(corner.x(), far)};
  if (std::abs(turn) < parallel || said.along.low < body.along.low - rounding_m ||
      said.along.high > body.along.high + rounding_m) {
    const double middle = 0.5 * (body.along.low + body.along.high);
    said.along = {middle - 0.5 * filling.width_m, middle + 0.5 * filling.width_m};
  }
  said.height.low =
      filling.kind == StepClass::door ? body.height.low : 0.5 * (body.height.low + body.height.high - filling.height_m);
  said.height.high = said.height.low + filling.height_m;
  return said;
}

double area(const WallBox& box) { return box.along.length() * box.height.length(); }

}  // namespace plumbline::bim
