// SPDX-License-Identifier: Apache-2.0
#include "tests/laws/walk.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "bim/digest/digest.h"
#include "bim/digest/float_mode.h"
#include "bim/load/load.h"
#include "bim/mesh/mesh.h"
#include "bim/random/stream.h"
#include "sim/route/route.h"
#include "slam/methods.h"
#include "tests/data.h"

namespace plumbline {

SimulatedWalk walk_quickstart(std::uint64_t seed, const std::vector<std::string>& rooms, double duration_s,
                              slam::LidarModelId lidar) {
  set_float_mode();
  const bim::Building building = bim::load_building(project_file("scenarios/library/quickstart.plan.yaml"));
  const bim::BuildingMesh mesh = bim::build_mesh(building);
  const sim::ClearanceMap space(building, 0);

  std::vector<Eigen::Vector2d> targets;
  for (const std::string& name : rooms) {
    const auto room = std::find_if(building.rooms.begin(), building.rooms.end(),
                                   [&](const bim::Room& candidate) { return candidate.id == name; });
    targets.push_back(space.room_targets(*room).at(0));
  }
  sim::WorldConfig config;
  config.seed = seed;
  config.lidar.model = lidar;
  config.start_W = targets.at(0);
  config.duration_s = duration_s;
  std::vector<Eigen::Vector2d> way;
  for (std::size_t i = 1; i < targets.size(); ++i) {
    const auto leg = space.path(targets[i - 1], targets[i]);
    way.insert(way.end(), leg.begin() + (i > 1 ? 1 : 0), leg.end());
  }
  const Eigen::Vector2d ahead = way.at(1) - way.at(0);
  config.waypoints = sim::on_floor(way, building.storeys.at(0).elevation_m);
  config.start_yaw = std::atan2(ahead.y(), ahead.x());

  SimulatedWalk walk;
  walk.plan = std::make_shared<const bim::Plan>(bim::make_plan(building));
  sim::World world(config, building, mesh);
  sim::WorldFrame frame;
  while (world.next(frame)) {
    if (walk.frames.empty()) walk.X_WR_start = frame.truth.poses.front().X_WR;
    walk.X_WR.push_back(frame.truth.poses.back().X_WR);
    walk.frames.push_back(std::move(frame.sensors));
  }
  return walk;
}

std::vector<std::string> all_methods() {
  std::vector<std::string> names;
  for (const auto& row : slam::methods())
    if (!row.variant) names.emplace_back(row.name);
  return names;
}

slam::MethodInput method_input(const SimulatedWalk& walk, const std::string& method, double yaw_error) {
  slam::MethodInput input;
  input.seed = method_seed(1, seed_name(*slam::find_method(method)));
  input.calibration = sim::World::calibration();
  input.plan = walk.plan;
  input.prior.yaw_W = wrap_angle(walk.X_WR_start.yaw() + yaw_error);
  input.prior.storey = walk.plan->storeys.front().name;
  return input;
}

Answer answer_of(const std::string& method, const slam::MethodInput& input,
                 const std::vector<slam::SensorFrame>& frames) {
  const auto estimator = slam::find_method(method)->make(input);
  Answer answer;
  for (const auto& frame : frames) {
    for (const auto& imu : frame.imu) estimator->on_imu(imu);
    for (const auto& odometry : frame.odometry) estimator->on_odometry(odometry);
    answer.outputs.push_back(estimator->on_scan(frame.scan));
  }
  answer.estimate = estimator->finish();
  return answer;
}

std::uint64_t digest_of(const Answer& answer) {
  Digest digest;
  for (const auto& output : answer.outputs) {
    digest.add(output.stamp).add(static_cast<int>(output.state)).add(output.X_FR.has_value() ? 1 : 0);
    if (output.X_FR) digest.add(*output.X_FR);
    for (const auto& stage : output.digests) digest.add(std::string_view(stage.stage)).add(stage.digest);
    for (const auto& hypothesis : output.hypotheses) digest.add(hypothesis.mass).add(hypothesis.X_WR);
  }
  for (const auto& pose : answer.estimate.trajectory) digest.add(pose.stamp).add(pose.X_FR);
  for (const auto& plane : answer.estimate.planes) digest.add(plane.plane_F).add(plane.p0).add(plane.p1);
  for (const auto& room : answer.estimate.rooms) digest.add(room.center_F);
  for (const auto& point : answer.estimate.map_F) digest.add(Eigen::Vector3d(point.cast<double>()));
  return digest.value();
}

double rmse_from_first_pose(const Answer& answer, const SimulatedWalk& walk) {
  const Pose X_WM = walk.X_WR.front() * answer.outputs.front().X_FR->inverse();
  double sum = 0.0;
  for (std::size_t i = 0; i < walk.X_WR.size(); ++i)
    sum += (X_WM * answer.outputs[i].X_FR->t - walk.X_WR[i].t).squaredNorm();
  return std::sqrt(sum / static_cast<double>(walk.X_WR.size()));
}

}  // namespace plumbline
