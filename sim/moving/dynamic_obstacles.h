// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "bim/rays/ray_scene.h"
#include "slam/io/records.h"

namespace plumbline::sim {

/// Someone who walks a line of points to its end and back, over and over, and stands still while the robot is near.
struct PersonConfig {
  std::vector<Eigen::Vector3d> points_W;  ///< on the floor, at least one
  double speed_mps = 0.8;
  double radius_m = 0.25;
  double height_m = 1.75;
};

/// A leaf that turns about an upright hinge. It is opened while the robot is near, and otherwise at the times given.
struct SwingDoorConfig {
  Eigen::Vector3d hinge_W = Eigen::Vector3d::Zero();  ///< on the floor
  double yaw_shut = 0.0;                              ///< direction from the hinge along the shut leaf, rad
  double swing = 0.0;                                 ///< from shut to open, positive counter-clockwise, rad
  double width_m = 0.9;
  double height_m = 2.1;
  double thickness_m = 0.04;
  double near_m = 1.5;          ///< from the middle of the shut leaf; far enough that the robot finds it open
  double travel_s = 1.0;        ///< to open or to shut
  std::vector<double> times_s;  ///< opens, shuts, opens, ...; shut before the first
};

/// People and doors that move through a run, on their own clock and by where the robot is. The LiDAR sees them; the
/// robot does not feel them. They are no part of the building: their elements are numbered from first_element on,
/// people first.
class MovingThings {
 public:
  static constexpr double keep_away_m = 1.0;  ///< people this near to the robot (in the plane) stand still

  /// Throws InternalError on a person without points.
  MovingThings(std::vector<PersonConfig> people, std::vector<SwingDoorConfig> doors, int first_element);

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
    std::size_t leg = 0;    ///< walks from points[leg] to points[leg + 1], or back
    double walked_m = 0.0;  ///< of that leg, seen from points[leg]
    bool back = false;
    bim::MovingBody body;
  };
  struct Door {
    SwingDoorConfig config;
    double open = 0.0;  ///< 0 shut, 1 open
    bim::MovingBody body;
  };
  static void walk(Person& person, double distance_m);
  static Eigen::Vector3d position(const Person& person);

  std::vector<Person> people_;
  std::vector<Door> doors_;
  slam::Nanoseconds stamp_ = 0;
};

}  // namespace plumbline::sim
