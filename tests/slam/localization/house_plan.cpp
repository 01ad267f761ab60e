// SPDX-License-Identifier: Apache-2.0
#include "tests/slam/localization/house_plan.h"

#include <array>
#include <string>

namespace plumbline::slam::synthetic {

bim::Plan plan_of(const House& house) {
  bim::Plan plan;
  plan.storeys.push_back({"ground", 0.0, house.height_m});
  for (std::size_t i = 0; i < house.boxes.size(); ++i) {
    const Box& box = house.boxes[i];
    // Clockwise, so that free space lies on the left of each side.
    const std::array<Eigen::Vector2d, 4> corners = {
        Eigen::Vector2d(box.min.x(), box.min.y()), Eigen::Vector2d(box.min.x(), box.max.y()),
        Eigen::Vector2d(box.max.x(), box.max.y()), Eigen::Vector2d(box.max.x(), box.min.y())};
    for (std::size_t k = 0; k < 4; ++k) {
      bim::PlanFace face;
      face.id = static_cast<int>(plan.faces.size());
      face.wall_id = "b" + std::to_string(i);
      face.side = static_cast<int>(k % 2);
      face.storey = 0;
      face.p0 = corners[k];
      face.p1 = corners[(k + 1) % 4];
      const Eigen::Vector2d e = (face.p1 - face.p0).normalized();
      face.plane_W.n = {-e.y(), e.x(), 0.0};
      face.plane_W.d = -face.plane_W.n.head<2>().dot(face.p0);
      face.z0 = box.min.z();
      face.z1 = box.max.z();
      plan.faces.push_back(face);
    }
  }
  for (std::size_t i = 0; i < house.rooms.size(); ++i) {
    bim::PlanRoom room;
    room.id = static_cast<int>(i);
    room.name = "r" + std::to_string(i);
    room.storey = 0;
    room.polygon = house.rooms[i];
    room.z1 = house.height_m;
    plan.rooms.push_back(room);
  }
  return plan;
}

bim::Plan moved(const bim::Plan& plan_W, const Pose& X_VW) {
  const auto move = [&](const Eigen::Vector2d& p) -> Eigen::Vector2d {
    return (X_VW * Eigen::Vector3d(p.x(), p.y(), 0.0)).head<2>();
  };
  bim::Plan plan = plan_W;
  for (bim::PlanStorey& storey : plan.storeys) storey.elevation_m += X_VW.t.z();
  for (bim::PlanFace& face : plan.faces) {
    face.p0 = move(face.p0);
    face.p1 = move(face.p1);
    face.plane_W = X_VW * face.plane_W;
    face.z0 += X_VW.t.z();
    face.z1 += X_VW.t.z();
    for (bim::FaceHole& hole : face.holes) {
      hole.z0 += X_VW.t.z();
      hole.z1 += X_VW.t.z();
    }
  }
  for (bim::PlanRoom& room : plan.rooms) {
    for (Eigen::Vector2d& p : room.polygon) p = move(p);
    room.z0 += X_VW.t.z();
    room.z1 += X_VW.t.z();
  }
  for (bim::PlanSolid& solid : plan.solids) {
    for (Eigen::Vector2d& p : solid.outline) p = move(p);
    solid.z0 += X_VW.t.z();
    solid.z1 += X_VW.t.z();
  }
  return plan;
}

House twin_rooms() {
  House house = one_room(5.0, 4.0);
  const House second = one_room(5.0, 4.0);
  const Eigen::Vector3d shift(9.0, 1.0, 0.0);
  for (Box box : second.boxes) {
    box.min += shift;
    box.max += shift;
    house.boxes.push_back(box);
  }
  for (Polygon2 room : second.rooms) {
    for (Eigen::Vector2d& p : room) p += shift.head<2>();
    house.rooms.push_back(room);
  }
  return house;
}

StoreyIndex storey_of(const bim::Plan& plan) {
  PlanIndexConfig config;
  config.visibility_rays = 8;
  return make_plan_index(plan, std::nullopt, config).storeys.front();
}

}  // namespace plumbline::slam::synthetic
