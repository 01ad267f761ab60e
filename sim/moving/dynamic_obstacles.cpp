// SPDX-License-Identifier: Apache-2.0
#include "sim/moving/dynamic_obstacles.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bim/errors.h"

namespace plumbline::sim {

namespace {

double seconds(slam::Nanoseconds stamp) { return 1e-9 * static_cast<double>(stamp); }

double segment_length(const PersonConfig& config, std::size_t segment) {
  return (config.points_W[segment + 1] - config.points_W[segment]).norm();
}

bool wanted_open(const SwingDoorConfig& door, double time_s, const Eigen::Vector3d& robot_W) {
  const Eigen::Vector2d along(std::cos(door.yaw_closed), std::sin(door.yaw_closed));
  const Eigen::Vector2d middle = door.hinge_W.head<2>() + 0.5 * door.width_m * along;
  const bool same_floor = std::abs(robot_W.z() - door.hinge_W.z()) < door.height_m;
  if (same_floor && (robot_W.head<2>() - middle).norm() < door.near_m) return true;
  const auto passed = std::upper_bound(door.times_s.begin(), door.times_s.end(), time_s) - door.times_s.begin();
  return passed % 2 == 1;
}

/// Whether the robot is so near to a person, on the same floor, that the person stands still.
bool is_near(const PersonConfig& config, const Eigen::Vector3d& person_W, const Eigen::Vector3d& robot_W) {
  const Eigen::Vector3d apart = robot_W - person_W;
  return std::abs(apart.z()) < config.height_m && apart.head<2>().norm() < DynamicObstacles::keep_away_m;
}

void forget(std::vector<bim::BodyStation>& stations, double time_s) {
  const auto after = std::upper_bound(stations.begin(), stations.end(), time_s,
                                      [](double t, const bim::BodyStation& s) { return t < s.time_s; });
  if (after - stations.begin() > 1) stations.erase(stations.begin(), after - 1);
}

}  // namespace

DynamicObstacles::DynamicObstacles(std::vector<PersonConfig> people, std::vector<SwingDoorConfig> doors,
                                   int first_element) {
  int element = first_element;
  for (PersonConfig& config : people) {
    if (config.points_W.empty()) throw InternalError("a person needs at least one point");
    Person person;
    const double r = config.radius_m;
    person.body = {bim::BodyShape::capsule, {-r, -r, 0.0}, {r, r, config.height_m}, element++, {}};
    person.config = std::move(config);
    people_.push_back(std::move(person));
  }
  for (SwingDoorConfig& config : doors) {
    Door door;
    const double half = 0.5 * config.thickness_m;
    door.body = {bim::BodyShape::box, {0.0, -half, 0.0}, {config.width_m, half, config.height_m}, element++, {}};
    door.config = std::move(config);
    doors_.push_back(std::move(door));
  }
}

Eigen::Vector3d DynamicObstacles::position(const Person& person) {
  const std::vector<Eigen::Vector3d>& points = person.config.points_W;
  if (points.size() == 1) return points[0];
  const double length = segment_length(person.config, person.segment);
  const double share = length > 0.0 ? person.walked_m / length : 0.0;
  return points[person.segment] + share * (points[person.segment + 1] - points[person.segment]);
}

void DynamicObstacles::walk(Person& person, double distance_m) {
  const std::size_t segments = person.config.points_W.size() - 1;
  // One turn-round at most for each step, so that a line of no length ends.
  for (std::size_t k = 0; k <= segments && segments > 0; ++k) {
    const double left = person.back ? person.walked_m : segment_length(person.config, person.segment) - person.walked_m;
    if (distance_m <= left) {
      person.walked_m += person.back ? -distance_m : distance_m;
      return;
    }
    distance_m -= left;
    const bool at_end = person.back ? person.segment == 0 : person.segment + 1 == segments;
    person.walked_m = person.back ? 0.0 : segment_length(person.config, person.segment);
    if (at_end) {
      person.back = !person.back;
    } else if (person.back) {
      --person.segment;
      person.walked_m = segment_length(person.config, person.segment);
    } else {
      ++person.segment;
      person.walked_m = 0.0;
    }
  }
}

void DynamicObstacles::begin_aside(Person& person, const Eigen::Vector3d& robot_W) {
  constexpr double step_m = 0.1;
  double way_m = 0.0;
  for (std::size_t k = 0; k + 1 < person.config.points_W.size(); ++k) way_m += segment_length(person.config, k);
  const Person first = person;
  for (double walked_m = 0.0; walked_m < way_m; walked_m += step_m) {
    if (!is_near(person.config, position(person), robot_W)) return;
    walk(person, step_m);
  }
  person = first;
}

// Back to its own way as soon as the robot lets it, out of the robot's way as far as that comes.
void DynamicObstacles::step_aside(Person& person, double elapsed_s, const Eigen::Vector3d& robot_W) {
  constexpr double back_mps = 1.6;  // twice a walk
  const Eigen::Vector3d left = position(person) - person.at_W;
  const double reach_m = std::max(back_mps, 2.0 * person.config.speed_mps) * elapsed_s;
  person.at_W += left.norm() > reach_m ? Eigen::Vector3d(reach_m / left.norm() * left) : left;
  const Eigen::Vector2d apart = (person.at_W - robot_W).head<2>();
  const double least_m = person.config.radius_m + aside_m, distance_m = apart.norm();
  if (distance_m >= least_m || !is_near(person.config, person.at_W, robot_W)) return;
  const Eigen::Vector2d way = distance_m > 0.0 ? Eigen::Vector2d(apart / distance_m) : Eigen::Vector2d::UnitX();
  person.at_W.head<2>() = robot_W.head<2>() + least_m * way;
}

void DynamicObstacles::step(slam::Nanoseconds stamp, const Eigen::Vector3d& robot_W) {
  for (Person& person : people_) {
    if (begun_) break;
    begin_aside(person, robot_W);
    person.at_W = position(person);
  }
  begun_ = true;
  const double elapsed_s = seconds(stamp - stamp_);
  stamp_ = stamp;
  for (Person& person : people_) {
    if (!is_near(person.config, position(person), robot_W)) walk(person, person.config.speed_mps * elapsed_s);
    step_aside(person, elapsed_s, robot_W);
    person.body.stations.push_back({seconds(stamp), person.at_W, 0.0});
  }
  for (Door& door : doors_) {
    const double move = elapsed_s / door.config.travel_s;
    door.open = std::clamp(door.open + (wanted_open(door.config, seconds(stamp), robot_W) ? move : -move), 0.0, 1.0);
    door.body.stations.push_back(
        {seconds(stamp), door.config.hinge_W, door.config.yaw_closed + door.open * door.config.swing});
  }
}

std::vector<bim::MovingBody> DynamicObstacles::bodies() const {
  std::vector<bim::MovingBody> bodies;
  for (const Person& person : people_) bodies.push_back(person.body);
  for (const Door& door : doors_) bodies.push_back(door.body);
  return bodies;
}

void DynamicObstacles::forget_before(slam::Nanoseconds t) {
  for (Person& person : people_) forget(person.body.stations, seconds(t));
  for (Door& door : doors_) forget(door.body.stations, seconds(t));
}

}  // namespace plumbline::sim
