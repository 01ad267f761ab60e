// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "bim/rays/ray_scene.h"
#include "slam/io/records.h"

namespace plumbline::sim {

/// A person who walks a polyline to its end and back, again and again, stands still while the robot is near, and steps
/// aside as far as it must where the robot walks on. Who would begin near the robot begins farther along, where there
/// is such a place.
struct PersonConfig {
  std::vector<Eigen::Vector3d> points_W;  ///< on the floor, at least one
  double speed_mps = 0.8;
  double radius_m = 0.25;
  double height_m = 1.75;
};

/// A leaf that turns about an upright hinge. It is opened while the robot is near, and otherwise at the times given.
struct SwingDoorConfig {
  Eigen::Vector3d hinge_W = Eigen::Vector3d::Zero();  ///< on the floor
  double yaw_closed = 0.0;                            ///< direction from the hinge along the closed leaf, rad
  double swing = 0.0;                                 ///< from closed to open, positive counter-clockwise, rad
  double width_m = 0.9;
  double height_m = 2.1;
  double thickness_m = 0.04;
  double near_m = 1.5;          ///< from the middle of the closed leaf; far enough that the robot finds it open
  double travel_s = 1.0;        ///< to open or to close
  std::vector<double> times_s;  ///< opens, closes, opens, ...; closed before the first
};

/// People and doors that move during a run, by the time and the robot's position. They are visible to the LiDAR; the
/// robot does not collide with them. They are no part of the building: their elements are numbered from first_element
/// on, people first.
class DynamicObstacles {
 public:
  static constexpr double keep_away_m = 1.0;  ///< people this near to the robot on their floor stand still
  static constexpr double aside_m = 0.35;     ///< from the robot's middle to a person who stepped aside

  /// Throws InternalError on a person without points.
  DynamicObstacles(std::vector<PersonConfig> people, std::vector<SwingDoorConfig> doors, int first_element);

  [[nodiscard]] bool empty() const { return people_.empty() && doors_.empty(); }
  /// Times must ascend, from 0 on. robot_W is where the robot is then.
  void step(slam::Nanoseconds stamp, const Eigen::Vector3d& robot_W);
  /// Where everything was at the steps since the last forget_before().
  [[nodiscard]] std::vector<bim::MovingBody> bodies() const;
  /// Drops what is not needed for times from t on.
  void forget_before(slam::Nanoseconds t);

 private:
  struct Person {
    PersonConfig config;
    std::size_t segment = 0;  ///< walks from points[segment] to points[segment + 1], or back
    double walked_m = 0.0;    ///< along that segment, from points[segment]
    bool back = false;
    Eigen::Vector3d at_W = Eigen::Vector3d::Zero();  ///< on that way, or aside of it
    bim::MovingBody body;
  };
  struct Door {
    SwingDoorConfig config;
    double open = 0.0;  ///< 0 closed, 1 open
    bim::MovingBody body;
  };
  static void walk(Person& person, double distance_m);
  static void begin_aside(Person& person, const Eigen::Vector3d& robot_W);
  static void step_aside(Person& person, double elapsed_s, const Eigen::Vector3d& robot_W);
  static Eigen::Vector3d position(const Person& person);

  std::vector<Person> people_;
  std::vector<Door> doors_;
  slam::Nanoseconds stamp_ = 0;
  bool begun_ = false;
};

}  // namespace plumbline::sim
