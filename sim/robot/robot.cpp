// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/robot.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "bim/digest/digest.h"
#include "bim/errors.h"
#include "sim/robot/box_pool.h"
#include "sim/robot/model.h"
#include "sim/robot/scenario_failure.h"
#include "sim/robot/terrain_noise.h"
#include "sim/robot/trot/trot.h"
#include "sim/robot/types/terrain.h"

namespace plumbline::sim {

namespace {

/// Settings of the robot's physics, besides the gait; docs/methods/robot.md.
struct RobotConfig {
  double start_height_m = 0.51;      ///< base above the ground, feet 5 mm in the air
  double start_foot_depth_m = 0.47;  ///< foot centres below the hips
  int settle_steps = 250;            ///< 0.5 s
  double pool_radius_m = 2.0;
  int pool_refresh_steps = 250;   ///< 0.5 s
  double fallen_up_z = 0.5;       ///< z of the base's up axis
  double fallen_height_m = 0.22;  ///< base above the ground
};

constexpr std::ptrdiff_t base_body = 1;
constexpr std::ptrdiff_t wrench_size = 6;  ///< force, then torque
constexpr int joint_qpos = 7;              ///< after the free joint's position and quaternion
constexpr int joint_dof = 6;

Eigen::Vector3d vector3(const double* v) { return {v[0], v[1], v[2]}; }

/// Everything that can be touched: what stands in the way, then the ground.
std::vector<CollisionBox> joined(std::vector<CollisionBox> boxes, const Ground& ground) {
  int id = 0;
  for (const CollisionBox& box : boxes) id = std::max(id, box.id + 1);
  for (CollisionBox box : ground.surfaces()) {
    box.id = id++;
    boxes.push_back(box);
  }
  return boxes;
}

}  // namespace

struct Robot::Impl {
  Impl(const Pose& X_WR_start, Ground ground_in, std::vector<CollisionBox> boxes, const Conditions& conditions,
       Seed seed)
      : ground(std::move(ground_in)),
        terrain([this](double x, double y, double z_max) { return ground.height(x, y, z_max); }),
        model_cfg{.friction = conditions.friction,
                  .plates = conditions.terrain_noise_m > 0.0 ? TerrainNoiseConfig().plates() : 0},
        model(load_model(model_xml(model_cfg))),
        data(make_data(*model)),
        pool(joined(std::move(boxes), ground), pool_geoms(*model, model_cfg.box_pool), config.pool_radius_m),
        pushes(conditions.pushes, model_cfg.step_s, seed),
        push_on_stairs(conditions.pushes.on_stairs) {
    if (conditions.terrain_noise_m > 0.0)
      terrain_noise.emplace(conditions.terrain_noise_m, X_WR_start.t.head<2>(), plate_geoms(*model, model_cfg.plates),
                            seed.run);
    place(X_WR_start);
    trot = std::make_unique<Trot>(TrotConfig{}, state(), mj_getTotalmass(model.get()), model_cfg.step_s);
    steps = -config.settle_steps;
    while (steps < 0) step(Command{});
  }

  void place(const Pose& X_WR_start) {
    const Pose X_WR =
        Pose::from_xyz_yaw({X_WR_start.t.x(), X_WR_start.t.y(),
                            terrain(X_WR_start.t.x(), X_WR_start.t.y(), X_WR_start.t.z()) + config.start_height_m},
                           X_WR_start.yaw());
    std::copy_n(X_WR.t.data(), 3, data->qpos);
    const Eigen::Vector4d q(X_WR.q.w(), X_WR.q.x(), X_WR.q.y(), X_WR.q.z());
    std::copy_n(q.data(), 4, data->qpos + 3);
    for (std::size_t leg = 0; leg < leg_count; ++leg) {
      const Eigen::Vector3d below(0.0, side_sign(leg) * robot_dimensions.abduction, -config.start_foot_depth_m);
      const LegAngles angles = leg_angles(leg, hip_R(leg) + below);
      std::copy_n(angles.data(), 3, data->qpos + joint_qpos + 3 * leg);
    }
    refresh_surroundings(X_WR.t);
    mj_forward(model.get(), data.get());
  }

  [[nodiscard]] Pose X_WR() const {
    const double* q = data->qpos + 3;
    return {Eigen::Quaterniond(q[0], q[1], q[2], q[3]), vector3(data->qpos)};
  }

  [[nodiscard]] BodyState state() const {
    BodyState s;
    s.X_WR = X_WR();
    s.v_W = vector3(data->qvel);
    s.omega_W = s.X_WR.q * vector3(data->qvel + 3);
    for (std::size_t leg = 0; leg < leg_count; ++leg) {
      s.q[leg] = vector3(data->qpos + joint_qpos + 3 * leg);
      s.qd[leg] = vector3(data->qvel + joint_dof + 3 * leg);
      s.bias[leg] = vector3(data->qfrc_bias + joint_dof + 3 * leg);
      s.touch[leg] = data->sensordata[static_cast<std::size_t>(sensors.touch) + leg];
    }
    s.com_W = vector3(data->subtree_com + 3 * base_body);
    return s;
  }

  /// Puts the nearby boxes and the floor into the physics.
  void refresh_surroundings(const Eigen::Vector3d& p_W) {
    pool.refresh(*model, p_W);
    place_floor(*model, ground.plane_height(p_W));
  }

  void step(const Command& command) {
    if (steps % config.pool_refresh_steps == 0) refresh_surroundings(vector3(data->qpos));
    lay_plates();
    const Torques torques = trot->update(state(), command, terrain);
    std::copy(torques.begin(), torques.end(), data->ctrl);
    const bool held_off = command.slow_gait && !push_on_stairs;
    const Eigen::Vector2d push_W = held_off ? Eigen::Vector2d::Zero() : pushes.force_W(steps);
    std::copy_n(push_W.data(), 2, data->xfrc_applied + wrench_size * base_body);
    mj_step(model.get(), data.get());
    ++steps;
    check_physics();
    check_upright();
  }

  void lay_plates() {
    const Eigen::Vector3d p_W = vector3(data->qpos);
    if (terrain_noise) terrain_noise->refresh(*model, p_W.head<2>(), ground.plane_height(p_W));
  }

  /// MuJoCo goes on after a warning, from a reset state if a number was bad.
  void check_physics() const {
    for (int i = 0; i < mjNWARNING; ++i)
      if (data->warning[i].number > 0)
        throw InternalError(std::string("MuJoCo: ") + mju_warningText(i, data->warning[i].lastinfo));
  }

  void check_upright() const {
    const Pose X = X_WR();
    const double up_z = (X.q * Eigen::Vector3d::UnitZ()).z();
    const double height = X.t.z() - terrain(X.t.x(), X.t.y(), X.t.z());
    if (up_z < config.fallen_up_z || height < config.fallen_height_m)
      throw scenario_failure("the robot fell", static_cast<double>(steps) * model_cfg.step_s, X.t);
  }

  RobotConfig config;
  SensorLayout sensors;
  Ground ground;
  Terrain terrain;
  ModelConfig model_cfg;
  ModelPtr model;
  DataPtr data;
  BoxPool pool;
  Pushes pushes;
  bool push_on_stairs;
  std::optional<TerrainNoise> terrain_noise;
  std::unique_ptr<Trot> trot;
  std::int64_t steps = 0;
};

Robot::Robot(const Pose& X_WR_start, Ground ground, std::vector<CollisionBox> boxes, const Conditions& conditions,
             Seed seed)
    : impl_(std::make_unique<Impl>(X_WR_start, std::move(ground), std::move(boxes), conditions, seed)) {}

Robot::~Robot() = default;

void Robot::step(const Command& command) { impl_->step(command); }

std::int64_t Robot::steps() const { return impl_->steps; }

Pose Robot::X_WR() const { return impl_->X_WR(); }

Eigen::Vector3d Robot::v_W() const { return vector3(impl_->data->qvel); }

Proprioception Robot::proprioception() const {
  const mjData& data = *impl_->data;
  Proprioception out;
  std::copy_n(data.qpos + joint_qpos, out.q.size(), out.q.begin());
  std::copy_n(data.qvel + joint_dof, out.qd.size(), out.qd.begin());
  std::copy_n(data.sensordata + impl_->sensors.touch, out.touch.size(), out.touch.begin());
  out.gyro_R = vector3(data.qvel + 3);
  out.accelerometer_R = vector3(data.sensordata + impl_->sensors.accelerometer);
  return out;
}

std::uint64_t Robot::digest() const {
  const mjModel& model = *impl_->model;
  const mjData& data = *impl_->data;
  const auto span = [](const double* p, int n) { return std::span<const double>(p, static_cast<std::size_t>(n)); };
  return Digest()
      .add(data.time)
      .add(span(data.qpos, model.nq))
      .add(span(data.qvel, model.nv))
      .add(span(data.qacc_warmstart, model.nv))
      .add(span(data.ctrl, model.nu))
      .add(span(data.sensordata, model.nsensordata))
      .value();
}

Pose Robot::X_RL() { return {Eigen::Quaterniond::Identity(), {0.0, 0.0, robot_dimensions.lidar_height}}; }

}  // namespace plumbline::sim
