// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/box_pool.h"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

namespace plumbline::sim {
namespace {

constexpr double yaw = 0.3;
constexpr double push_n = 250.0;

/// A wall whose face stands 0.6 m ahead of the origin, not square to it.
CollisionBox wall() {
  CollisionBox box;
  box.X_WB = Pose::from_xyz_yaw({0.7, 0.1, 1.0}, yaw);
  box.half = {0.1, 3.0, 1.0};
  return box;
}

ModelConfig one_box() {
  ModelConfig config;
  config.box_pool = 1;
  return config;
}

/// The model as if its one box had been a wall from the start.
ModelPtr model_with_wall() {
  std::string xml = model_xml(one_box());
  const std::string parked = "size='0.01 0.01 0.01' pos='0 0 -50'";
  const CollisionBox box = wall();
  const Eigen::Quaterniond& q = box.X_WB.q;
  std::ostringstream placed;
  placed.precision(17);
  placed << "size='" << box.half.transpose() << "' pos='" << box.X_WB.t.transpose() << "' quat='" << q.w() << " "
         << q.x() << " " << q.y() << " " << q.z() << "'";
  const std::size_t at = xml.find(parked);
  EXPECT_NE(at, std::string::npos);
  return load_model(xml.replace(at, parked.size(), placed.str()));
}

/// The robot as its model has it, legs straight, pushed ahead in the air.
void place_robot(const mjModel& model, mjData& data) {
  mj_resetData(&model, &data);
  data.qpos[2] = 1.2;
  data.xfrc_applied[6] = push_n;
}

/// Contact forces with the wall at each of some steps: along its normal and friction, N.
std::vector<Eigen::Vector3d> forces(const mjModel& model, mjData& data, int steps) {
  const int geom = pool_geoms(model, 1)[0];
  std::vector<Eigen::Vector3d> out;
  for (int i = 0; i < steps; ++i) {
    mj_step(&model, &data);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int c = 0; c < data.ncon; ++c) {
      if (data.contact[c].geom1 != geom && data.contact[c].geom2 != geom) continue;
      std::array<double, 6> force{};
      mj_contactForce(&model, &data, c, force.data());
      sum += Eigen::Vector3d(force[0], force[1], force[2]);
    }
    out.push_back(sum);
  }
  return out;
}

TEST(BoxPool, ABoxThatCameByRewritingIsFeltLikeOneThatWasAlwaysThere) {
  constexpr int steps = 300;
  const ModelPtr always = model_with_wall();
  const DataPtr always_data = make_data(*always);
  place_robot(*always, *always_data);
  const std::vector<Eigen::Vector3d> expected = forces(*always, *always_data, steps);

  const ModelPtr rewritten = load_model(model_xml(one_box()));
  const DataPtr rewritten_data = make_data(*rewritten);
  const BoxPool pool({wall()}, pool_geoms(*rewritten, 1), 2.0);
  pool.refresh(*rewritten, {-10.0, 0.0, 0.5});
  place_robot(*rewritten, *rewritten_data);
  for (const Eigen::Vector3d& force : forces(*rewritten, *rewritten_data, steps)) EXPECT_TRUE(force.isZero());
  EXPECT_GT(rewritten_data->qpos[0], 0.5);  // through where the wall is to stand

  pool.refresh(*rewritten, {0.0, 0.0, 0.5});
  place_robot(*rewritten, *rewritten_data);
  EXPECT_EQ(forces(*rewritten, *rewritten_data, steps), expected);
  EXPECT_TRUE(std::equal(always_data->qpos, always_data->qpos + always->nq, rewritten_data->qpos));
  double most = 0.0;
  for (const Eigen::Vector3d& force : expected) most = std::max(most, force.x());
  EXPECT_GT(most, push_n);
}

TEST(BoxPool, ABoxThatLeftThePoolIsNotFelt) {
  const ModelPtr model = load_model(model_xml(one_box()));
  const DataPtr data = make_data(*model);
  const BoxPool pool({wall()}, pool_geoms(*model, 1), 2.0);
  pool.refresh(*model, {0.0, 0.0, 0.5});
  pool.refresh(*model, {-10.0, 0.0, 0.5});
  place_robot(*model, *data);
  for (const Eigen::Vector3d& force : forces(*model, *data, 300)) EXPECT_TRUE(force.isZero());
}

}  // namespace
}  // namespace plumbline::sim
