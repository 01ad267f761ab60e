// SPDX-License-Identifier: Apache-2.0
#include "sim/world.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bim/digest/digest.h"
#include "bim/errors.h"
#include "bim/mesh/visible.h"
#include "bim/rays/ray_scene.h"
#include "sim/pose_track.h"
#include "sim/robot/collision.h"
#include "sim/robot/leg_odometry.h"
#include "sim/robot/robot.h"
#include "slam/io/stopwatch.h"

namespace plumbline::sim {

namespace {

using slam::Nanoseconds;

constexpr int imu_every = 2;               ///< physics steps: 250 Hz
constexpr int pose_every = 5;              ///< physics steps: 100 Hz, odometry and truth
constexpr double same_floor_m = 0.3;       ///< a waypoint this close to a storey's floor lies on it
constexpr double start_clearance_m = 1.0;  ///< the floor is searched below this height above the storey

/// The storey of the start and those on whose floor a waypoint lies, ascending.
std::vector<int> walked_storeys(const WorldConfig& config, const bim::Building& building) {
  std::vector<int> out;
  for (int i = 0; i < static_cast<int>(building.storeys.size()); ++i) {
    const double z = building.storeys[static_cast<std::size_t>(i)].elevation_m;
    const bool visited = std::any_of(config.waypoints.begin(), config.waypoints.end(),
                                     [&](const Waypoint& w) { return std::abs(w.p_W.z() - z) < same_floor_m; });
    if (i == config.storey || visited) out.push_back(i);
  }
  return out;
}

double elevation(const bim::Building& building, int storey) {
  if (storey < 0 || static_cast<std::size_t>(storey) >= building.storeys.size())
    throw InputError({}, "the building has no storey number " + std::to_string(storey));
  return building.storeys[static_cast<std::size_t>(storey)].elevation_m;
}

Pose start_pose(const WorldConfig& config, double floor) {
  return Pose::from_xyz_yaw({config.start_W.x(), config.start_W.y(), floor + start_clearance_m}, config.start_yaw);
}

PurePursuitConfig pursuit_config(const WorldConfig& config) {
  PurePursuitConfig out;
  out.speed.speed_mps = config.speed_mps;
  return out;
}

Nanoseconds nanoseconds(double seconds) { return std::llround(seconds * 1e9); }

/// Time of the last return slot of the firing before `firing`.
Nanoseconds end_of_firings(const slam::LidarModel& model, std::int64_t firing) {
  return (firing - 1) * model.firing_period_ns + slam::last_laser_ns(model);
}

/// The faces that rays can hit: without optics there are no panes.
bim::RayScene make_scene(const LidarConfig& lidar, const bim::Building& as_built, const bim::BuildingMesh& mesh) {
  return lidar.optics ? bim::RayScene(mesh) : bim::RayScene(bim::visible_mesh(as_built, mesh));
}

/// Moves the records up to and including time t from the front of `pending` to `out`.
template <class Record>
void take_until(Nanoseconds t, std::vector<Record>& pending, std::vector<Record>& out) {
  auto end = pending.begin();
  while (end != pending.end() && end->stamp <= t) ++end;
  out.assign(pending.begin(), end);
  pending.erase(pending.begin(), end);
}

}  // namespace

struct World::Impl {
  Impl(const WorldConfig& config_in, const bim::Building& as_built, const bim::BuildingMesh& mesh)
      : config(config_in),
        seed(config.seed, config.part),
        floor(elevation(as_built, config.storey)),
        scene(make_scene(config.lidar, as_built, mesh)),
        dynamic_obstacles(config.people, config.doors, static_cast<int>(mesh.elements.size())),
        rooms(as_built),
        lidar(config.lidar, config.rpm, seed, scene, surfaces_of(as_built, mesh, config.lidar.reflectivity), &rooms),
        X_WL(static_cast<std::size_t>(slam::firings_per_message(lidar.model(), config.rpm))),
        robot(start_pose(config, floor), building_ground(as_built, walked_storeys(config, as_built)),
              collision_boxes(as_built, walked_storeys(config, as_built)), config.conditions, seed),
        pursuit(pursuit_config(config), config.waypoints, seed),
        sensors(config.odometry, seed, config.faults.imu, config.faults.slip),
        leg_odometry(leg_odometry_config(config.odometry, config.seed)),
        odometry_stamps(config.faults.clock, seed, 0),
        imu_stamps(config.faults.clock, seed, 1) {
    record(0);
  }

  bool next(WorldFrame& frame) {
    const std::int64_t end_firing = next_firing + static_cast<std::int64_t>(X_WL.size());
    const Nanoseconds stamp = end_of_firings(lidar.model(), end_firing);
    if (finished(stamp)) return false;
    slam::Stopwatch stopwatch;
    while (track.last_stamp() < stamp + longest_lead(config.faults.clock)) step();

    WorldFrame out;
    out.times.push_back({"sim.physics", stopwatch.cpu_ms()});
    take_until(stamp, imu, out.sensors.imu);
    take_until(stamp, odometry, out.sensors.odometry);
    take_until(stamp, covariances, out.sensors.covariances);
    take_until(stamp, true_poses, out.truth.poses);
    std::vector<TruePose>& poses = out.truth.poses;
    if (poses.empty() || poses.back().stamp < stamp) poses.push_back({stamp, track.at(stamp)});
    stopwatch.restart();
    scan(out);
    out.times.push_back({"sim.lidar", stopwatch.cpu_ms()});
    if (out.sensors.scan.stamp != stamp) throw InternalError("the decoded scan does not end when its last laser fired");
    out.truth.robot_digest = Digest().add(robot.digest()).add(leg_odometry.X_OR()).value();
    next_firing = end_firing;
    track.forget_before(next_firing * lidar.model().firing_period_ns);
    dynamic_obstacles.forget_before(next_firing * lidar.model().firing_period_ns);
    frame = std::move(out);
    return true;
  }

  [[nodiscard]] bool finished(Nanoseconds stamp) const {
    if (stamp > nanoseconds(config.duration_s)) return true;
    return route_done_at && stamp > *route_done_at + nanoseconds(config.stand_s);
  }

  void step() {
    const std::int64_t tick = robot.steps();
    robot.step(pursuit.update(robot.X_WR(), tick));
    if (config.waypoints.size() > 1 && pursuit.done() && !route_done_at) route_done_at = tick * Robot::step_ns;
    record(tick + 1);
  }

  /// What the sensors and the scorer record at a physics step.
  void record(std::int64_t tick) {
    const Nanoseconds stamp = tick * Robot::step_ns;
    const Pose X_WR = robot.X_WR();
    const SensorReading reading = sensors.read(robot.proprioception(), tick);
    if (tick > 0) leg_odometry.update(reading, 1e-9 * static_cast<double>(Robot::step_ns));
    track.add(stamp, X_WR);
    dynamic_obstacles.step(stamp, X_WR.t);
    if (tick % imu_every == 0) record_imu(tick, reading);
    if (tick % pose_every == 0) {
      record_odometry(tick);
      true_poses.push_back({stamp, X_WR});
    }
  }

  void record_imu(std::int64_t tick, const SensorReading& reading) {
    if (const auto stamp = imu_stamps.stamp(tick, tick * Robot::step_ns))
      imu.push_back({*stamp, reading.gyro_R, reading.accelerometer_R});
  }

  void record_odometry(std::int64_t tick) {
    const auto stamp = odometry_stamps.stamp(tick, tick * Robot::step_ns);
    if (!stamp) return;
    odometry.push_back({*stamp, leg_odometry.X_OR()});
    if (tick > 0) covariances.push_back({*stamp, leg_odometry.take_covariance()});
  }

  void scan(WorldFrame& out) {
    if (!dynamic_obstacles.empty()) scene.set_bodies(dynamic_obstacles.bodies());
    for (std::size_t i = 0; i < X_WL.size(); ++i) {
      const std::int64_t firing = next_firing + static_cast<std::int64_t>(i);
      X_WL[i] = track.at(firing * lidar.model().firing_period_ns) * Robot::X_RL();
    }
    lidar.sweep(next_firing, X_WL, sweep);
    out.sensors.packets = sweep.packets;
    out.truth.labels = sweep.labels;
    out.sensors.scan = lidar.decode(next_firing, sweep, config.vertical_offsets);
  }

  WorldConfig config;
  Seed seed;
  double floor;
  bim::RayScene scene;
  DynamicObstacles dynamic_obstacles;
  RoomLookup rooms;
  Lidar lidar;
  std::vector<Pose> X_WL;  ///< of the firings of one message
  Sweep sweep;
  Robot robot;
  PurePursuit pursuit;
  ProprioceptiveSensors sensors;
  LegOdometry leg_odometry;
  StampError odometry_stamps, imu_stamps;

  PoseTrack track;
  std::vector<slam::Imu> imu;
  std::vector<slam::Odometry> odometry;
  std::vector<slam::OdometryCovariance> covariances;
  std::vector<TruePose> true_poses;
  std::int64_t next_firing = 0;
  std::optional<Nanoseconds> route_done_at;
};

World::World(const WorldConfig& config, const bim::Building& as_built, const bim::BuildingMesh& mesh)
    : impl_(std::make_unique<Impl>(config, as_built, mesh)) {}

World::~World() = default;

bool World::next(WorldFrame& frame) { return impl_->next(frame); }

slam::Calibration World::calibration() {
  slam::Calibration calibration;
  calibration.X_RL = Robot::X_RL();
  return calibration;
}

}  // namespace plumbline::sim
