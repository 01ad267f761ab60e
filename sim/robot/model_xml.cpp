// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <locale>
#include <sstream>

#include "sim/robot/model.h"
#include "sim/robot/types/dimensions.h"

namespace plumbline::sim {

namespace {

constexpr std::array<const char*, leg_count> leg_names = {"FL", "FR", "HL", "HR"};
constexpr std::array<const char*, 3> joint_names = {"hx", "hy", "kn"};
constexpr std::array<int, 3> torque_max = {60, 60, 115};  ///< N m, hx, hy, kn

void write_header(std::ostream& out, const ModelConfig& c) {
  out << "<mujoco model='quadruped'>"
         "<compiler angle='radian' coordinate='local' inertiafromgeom='false' boundmass='0'/>"
      << "<size njmax='" << c.constraint_rows_max << "' nconmax='" << c.contacts_max << "'/>"
      << "<option timestep='" << c.step_s
      << "' integrator='Euler' solver='Newton' iterations='20' tolerance='1e-10' cone='elliptic' impratio='10'/>"
      << "<default><joint damping='0.5' armature='0.03' frictionloss='0.1' limited='true'/>"
      << "<geom condim='3' contype='1' conaffinity='2' mass='0' friction='" << c.friction << " 0.02 0.01'/>"
      << "<default class='world'><geom contype='2' conaffinity='1'/></default>"
      << "<motor ctrllimited='true'/></default>";
}

/// Boxes of the world body; an unused one waits far below the floor.
void write_boxes(std::ostream& out, const char* name, int count) {
  for (int i = 0; i < count; ++i)
    out << "<geom class='world' name='" << name << i << "' type='box' size='0.01 0.01 0.01' pos='0 0 -50'/>";
}

void write_world(std::ostream& out, const ModelConfig& c) {
  out << "<geom class='world' name='floor' type='plane' size='0 0 1' />";
  write_boxes(out, "pool", c.box_pool);
  write_boxes(out, "plate", c.plates);
}

void write_inertia(std::ostream& out, double mass, const Eigen::Vector3d& com, const Eigen::Vector3d& inertia) {
  out << "<inertial mass='" << mass << "' pos='" << com.x() << " " << com.y() << " " << com.z() << "' diaginertia='"
      << inertia.x() << " " << inertia.y() << " " << inertia.z() << "'/>";
}

void write_leg(std::ostream& out, std::size_t leg) {
  const RobotDimensions& d = robot_dimensions;
  const double s = side_sign(leg);
  const double f = front_sign(leg);
  const std::string name = leg_names[leg];
  out << "<body name='" << name << "_hip' pos='" << d.hip_x * f << " " << d.hip_y * s << " 0'>";
  write_inertia(out, 1.7, {-0.005 * f, 0.013 * s, 0.0}, {0.0023, 0.0021, 0.0018});
  out << "<joint name='" << name << "_hx' axis='1 0 0' range='-0.785 0.785'/>"
      << "<geom type='sphere' size='0.06' pos='0 " << 0.06 * s << " 0'/>"
      << "<body name='" << name << "_upper' pos='0 " << d.abduction * s << " 0'>";
  write_inertia(out, 2.3, {0.0, 0.0, -0.12}, {0.0275, 0.0273, 0.0028});
  out << "<joint name='" << name << "_hy' axis='0 1 0' range='-0.9 2.29'/>"
      << "<geom type='capsule' size='0.045' fromto='0 0 0 0 0 -0.30'/>"
      << "<body name='" << name << "_lower' pos='0 0 " << -d.thigh << "'>";
  write_inertia(out, 0.4, {0.0, 0.0, -0.16}, {0.0041, 0.0041, 0.0002});
  out << "<joint name='" << name << "_kn' axis='0 1 0' range='-2.79 -0.25'/>"
      << "<geom type='capsule' size='0.02' fromto='0 0 0 0 0 -0.31'/>"
      << "<geom name='" << name << "_foot' type='sphere' size='" << d.foot_radius << "' pos='0 0 " << -d.shank
      << "' solref='0.01 1'/>"
      << "<site name='" << name << "_touch' type='sphere' size='" << d.foot_radius + 0.004 << "' pos='0 0 " << -d.shank
      << "'/></body></body></body>";
}

void write_robot(std::ostream& out) {
  out << "<body name='base' pos='0 0 1'><freejoint name='root'/>";
  write_inertia(out, 15.0, {0.0, 0.0, 0.0}, {0.14, 0.80, 0.85});
  out << "<geom type='box' size='0.425 0.12 0.085'/><site name='imu'/>"
      << "<body name='lidar_mount' pos='0 0 " << robot_dimensions.lidar_height << "'>";
  write_inertia(out, 1.0, {0.0, 0.0, 0.0}, {0.002, 0.002, 0.002});
  out << "<geom type='cylinder' size='0.052 0.036'/><site name='lidar'/></body>";
  for (std::size_t leg = 0; leg < leg_count; ++leg) write_leg(out, leg);
  out << "</body>";
}

void write_actuators(std::ostream& out) {
  out << "<actuator>";
  for (const char* leg : leg_names)
    for (std::size_t j = 0; j < joint_names.size(); ++j)
      out << "<motor joint='" << leg << "_" << joint_names[j] << "' ctrlrange='" << -torque_max[j] << " "
          << torque_max[j] << "'/>";
  out << "</actuator>";
}

void write_joint_sensors(std::ostream& out, const char* kind) {
  for (const char* leg : leg_names)
    for (const char* joint : joint_names) out << "<" << kind << " joint='" << leg << "_" << joint << "'/>";
}

void write_sensors(std::ostream& out) {
  out << "<sensor><accelerometer site='imu'/><gyro site='imu'/><framequat objtype='site' objname='imu'/>";
  write_joint_sensors(out, "jointpos");
  write_joint_sensors(out, "jointvel");
  for (const char* leg : leg_names) out << "<touch site='" << leg << "_touch'/>";
  out << "<framepos objtype='site' objname='lidar'/><framequat objtype='site' objname='lidar'/></sensor>";
}

}  // namespace

std::string model_xml(const ModelConfig& config) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(17);
  write_header(out, config);
  out << "<worldbody>";
  write_world(out, config);
  write_robot(out);
  out << "</worldbody>";
  write_actuators(out);
  write_sensors(out);
  out << "</mujoco>";
  return out.str();
}

}  // namespace plumbline::sim
