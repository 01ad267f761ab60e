// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "bim/errors.h"
#include "scenarios/app/bench/bench.h"
#include "scenarios/app/bench/bench_stairs.h"
#include "sim/robot/leg_odometry.h"
#include "sim/route/pure_pursuit.h"

namespace plumbline::scenarios {

namespace {

/// Laps of a rectangle, counter-clockwise from its corner at the origin.
struct WalkConfig {
  double length_m = 9.0;
  double width_m = 5.0;
  double speed_mps = 0.8;
  double seconds = 120.0;
  double window_s = 1.0;  ///< speeds are compared as means over so long
  double drift_m = 10.0;  ///< way over which the drift of odometry is measured
  double ramp_m = 2.0;    ///< length of each slope of the ramp
  double ramp_rad = 10.0 * std::numbers::pi / 180.0;
  double sill_m = 0.12;  ///< depth of the bars across the way
  double sill_high_m = 0.025;
};

struct Case {
  std::string name;
  sim::Conditions conditions;
  std::vector<sim::CollisionBox> surfaces = {};
  bool all_seeds = false;  ///< else half of them
  bool tracking = false;   ///< how well the route is followed, too, which the floor hardly changes
};

struct Walk {
  bool fell = false;
  double speed_error_mps = 0.0;  ///< rms
  double cross_track_m = 0.0;    ///< largest
  double tilt_deg = 0.0;         ///< rms, of the base against the vertical
  double drift_percent = 0.0;    ///< of odometry from legs without noise, mean; shows where feet slip
};

/// A box under the way along x whose upper side, tilted by pitch, has its middle at (x, 0, z).
sim::CollisionBox plank(double x, double z, double pitch, double length, double thickness) {
  sim::CollisionBox box;
  const Eigen::Quaterniond q(Eigen::AngleAxisd(-pitch, Eigen::Vector3d::UnitY()));
  box.half = {0.5 * length, 1.0, 0.5 * thickness};
  box.X_WB = {q, Eigen::Vector3d(x, 0.0, z) - q * Eigen::Vector3d(0.0, 0.0, box.half.z())};
  return box;
}

std::vector<sim::CollisionBox> ramp(const WalkConfig& config) {
  const double rise = config.ramp_m * std::sin(config.ramp_rad);
  const double run = config.ramp_m * std::cos(config.ramp_rad);
  const double middle = 0.5 * config.length_m;
  return {plank(middle - 0.5 * (1.0 + run), 0.5 * rise, config.ramp_rad, config.ramp_m, 0.1),
          plank(middle, rise, 0.0, 1.0, rise),
          plank(middle + 0.5 * (1.0 + run), 0.5 * rise, -config.ramp_rad, config.ramp_m, 0.1)};
}

std::vector<sim::CollisionBox> sills(const WalkConfig& config) {
  std::vector<sim::CollisionBox> out;
  for (const double x : {2.0, 4.0, 6.0, 7.0}) out.push_back(plank(x, config.sill_high_m, 0.0, config.sill_m, 0.1));
  return out;
}

std::vector<Case> cases(const WalkConfig& config) {
  std::vector<Case> out(6);
  out[0].name = "flat";
  out[0].all_seeds = out[0].tracking = true;
  out[1].name = "pushed";
  out[1].all_seeds = out[1].tracking = true;
  out[1].conditions.pushes = {.min_n = 60.0, .max_n = 150.0};
  out[2].name = "uneven";
  out[2].conditions.terrain_noise_m = 0.015;
  out[3].name = "slippery";
  out[3].conditions.friction = 0.25;  // feet begin to slip below 0.3
  out[4].name = "ramp";
  out[4].surfaces = ramp(config);
  out[5].name = "sills";
  out[5].surfaces = sills(config);
  return out;
}

std::vector<sim::Waypoint> laps(const WalkConfig& config) {
  std::vector<Eigen::Vector2d> out;
  const int count =
      static_cast<int>(config.speed_mps * config.seconds / (2.0 * (config.length_m + config.width_m))) + 1;
  for (int lap = 0; lap < count; ++lap)
    for (const auto& [x, y] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}})
      out.emplace_back(x * config.length_m, y * config.width_m);
  return sim::on_floor(out, 0.0);
}

double cross_track(const Eigen::Vector2d& p, const WalkConfig& config) {
  const Eigen::AlignedBox2d inside(Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(config.length_m, config.width_m));
  if (!inside.contains(p)) return inside.exteriorDistance(p);
  return std::min((p - inside.min()).minCoeff(), (inside.max() - p).minCoeff());
}

/// Sums up how far the velocity ahead is off the one asked for.
class SpeedError {
 public:
  explicit SpeedError(int window) : window_(window) {}
  void add(double asked, double walked) {
    sum_ += walked - asked;
    if (++count_ % window_ != 0) return;
    squares_ += std::pow(sum_ / window_, 2);
    sum_ = 0.0;
  }
  [[nodiscard]] double rms() const {
    const int windows = count_ / window_;
    return windows == 0 ? 0.0 : std::sqrt(squares_ / windows);
  }

 private:
  int window_;
  int count_ = 0;
  double sum_ = 0.0;
  double squares_ = 0.0;
};

/// Tilt of the base and drift of leg odometry over a walk.
class FloorEffects {
 public:
  FloorEffects(double step_s, std::uint64_t seed)
      : step_s_(step_s),
        sensors_(sim::OdometryPreset::ideal, seed),
        odometry_(sim::leg_odometry_config(sim::OdometryPreset::ideal, seed)) {}

  void add(const sim::Robot& robot, std::int64_t tick) {
    const sim::SensorReading reading = sensors_.read(robot.proprioception(), tick);
    if (tick > 0) odometry_.update(reading, step_s_);
    const Pose X_WR = robot.X_WR();
    const double up_z = (X_WR.q * Eigen::Vector3d::UnitZ()).z();
    squared_tilt_ += std::pow(std::acos(std::min(1.0, up_z)), 2);
    ++count_;
    if (tick % every_ != 0) return;
    if (!X_WR_.empty()) walked_m_ += (X_WR.t - X_WR_.back().t).head<2>().norm();
    X_WR_.push_back(X_WR);
    X_OR_.push_back(odometry_.X_OR());
    way_m_.push_back(walked_m_);
  }
  [[nodiscard]] double tilt_deg() const {
    return count_ == 0 ? 0.0 : std::sqrt(squared_tilt_ / count_) * 180.0 / std::numbers::pi;
  }
  /// Mean over all stretches of length_m; 0 where the way is shorter.
  [[nodiscard]] double drift_percent(double length_m) const {
    double sum = 0.0;
    int stretches = 0;
    for (std::size_t i = 0, j = 0; i < way_m_.size(); ++i) {
      while (j < way_m_.size() && way_m_[j] - way_m_[i] < length_m) ++j;
      if (j == way_m_.size()) break;
      const Eigen::Vector3d walked = (X_WR_[i].inverse() * X_WR_[j]).t;
      sum += ((X_OR_[i].inverse() * X_OR_[j]).t - walked).norm() / length_m;
      ++stretches;
    }
    return stretches == 0 ? 0.0 : 100.0 * sum / stretches;
  }

 private:
  static constexpr std::int64_t every_ = 50;  ///< steps from pose to pose, 0.1 s
  double step_s_;
  sim::ProprioceptiveSensors sensors_;
  sim::LegOdometry odometry_;
  std::vector<Pose> X_WR_, X_OR_;
  std::vector<double> way_m_;
  double walked_m_ = 0.0;
  double squared_tilt_ = 0.0;
  int count_ = 0;
};

Walk walk(const Case& c, const WalkConfig& config, std::uint64_t seed) {
  Walk out;
  const double step_s = 1e-9 * static_cast<double>(sim::Robot::step_ns);
  SpeedError error(static_cast<int>(config.window_s / step_s));
  FloorEffects floor(step_s, seed);
  sim::PurePursuitConfig pursuit_config;
  pursuit_config.speed.speed_mps = config.speed_mps;
  try {
    sim::Robot robot(Pose::from_xyz_yaw({0.0, 0.0, 1.0}, 0.0), sim::Ground({{0.0, {}}}, c.surfaces), {}, c.conditions,
                     seed);
    sim::PurePursuit pursuit(pursuit_config, laps(config), seed);
    for (std::int64_t tick = 0; static_cast<double>(tick) * step_s < config.seconds; ++tick) {
      const Pose X_WR = robot.X_WR();
      const sim::Command command = pursuit.update(X_WR, tick);
      robot.step(command);
      floor.add(robot, tick);
      const Eigen::Vector2d ahead(std::cos(X_WR.yaw()), std::sin(X_WR.yaw()));
      error.add(command.vx, ahead.dot(robot.v_W().head<2>()));
      out.cross_track_m = std::max(out.cross_track_m, cross_track(X_WR.t.head<2>(), config));
    }
  } catch (const ScenarioFailure&) {
    out.fell = true;
  }
  out.speed_error_mps = error.rms();
  out.tilt_deg = floor.tilt_deg();
  out.drift_percent = floor.drift_percent(config.drift_m);
  return out;
}

}  // namespace

std::vector<BenchRow> bench_legs(const BenchSetting& setting) {
  const WalkConfig config;
  std::vector<BenchRow> rows;
  for (const Case& c : cases(config)) {
    double falls = 0.0;
    std::vector<double> speeds, tracks, tilts, drifts;
    const int seeds = c.all_seeds ? setting.repetitions : (setting.repetitions + 1) / 2;
    for (int seed = 1; seed <= seeds; ++seed) {
      setting.step();
      const Walk one = walk(c, config, static_cast<std::uint64_t>(seed));
      falls += one.fell ? 1.0 : 0.0;
      speeds.push_back(one.speed_error_mps);
      tracks.push_back(one.cross_track_m);
      tilts.push_back(one.tilt_deg);
      drifts.push_back(one.drift_percent);
    }
    const std::string name = "legs." + c.name;
    rows.push_back(make_row(name + "_falls", "of " + std::to_string(seeds), {falls},
                            BenchLimit{.value = 0.0, .at_most = true, .gates = true}));
    rows.push_back(make_row(name + "_tilt_deg", "deg", tilts));
    rows.push_back(make_row(name + "_drift_percent", "%", drifts));
    if (!c.tracking) continue;
    rows.push_back(make_row(name + "_speed_error_mps", "m/s", speeds));
    rows.push_back(make_row(name + "_cross_track_m", "m", tracks));
  }
  for (const BenchRow& row : bench_stairs(setting)) rows.push_back(row);
  return rows;
}

}  // namespace plumbline::scenarios
