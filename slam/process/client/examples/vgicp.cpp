// SPDX-License-Identifier: Apache-2.0
// vgicp of this program as a process: it gives the same poses, to the bit, as the built-in method.
#include "bim/config/tree.h"
#include "bim/digest/float_mode.h"
#include "slam/methods.h"
#include "slam/process/client/plumbline_client.hpp"

namespace {

using namespace plumbline;
namespace client = plumbline_client;

Pose pose_of(const client::Pose& p) { return {{p.q[3], p.q[0], p.q[1], p.q[2]}, {p.t[0], p.t[1], p.t[2]}}; }

client::Pose wire_of(const Pose& X) { return {{X.t.x(), X.t.y(), X.t.z()}, {X.q.x(), X.q.y(), X.q.z(), X.q.w()}}; }

slam::MethodInput input_of(const Tree& hello) {
  slam::MethodInput input;
  input.seed = std::stoull(hello.find("seed")->as_string());
  input.has_odometry = hello.find("has_odometry")->as_bool();
  client::Pose mount;
  for (std::size_t i = 0; i < 7; ++i)
    (i < 3 ? mount.t[i] : mount.q[i - 3]) = hello.find("X_RL")->as_list()[i].as_double();
  input.calibration.X_RL = pose_of(mount);
  input.calibration.sensor_height_m = hello.find("sensor_height_m")->as_double();
  return input;
}

/// `scan` is used again, so that its memory is there already.
void copy_scan(const client::Scan& from, slam::Scan& scan) {
  scan.stamp = from.stamp_ns;
  scan.rings = from.rings;
  scan.columns = from.columns;
  scan.range_m.assign(from.range_m.begin(), from.range_m.end());
  scan.point_L.resize(from.point_L.size());
  for (std::size_t i = 0; i < from.point_L.size(); ++i)
    scan.point_L[i] = {from.point_L[i].x, from.point_L[i].y, from.point_L[i].z};
  scan.reflectivity.assign(from.reflectivity.begin(), from.reflectivity.end());
  scan.offset_ns.assign(from.offset_ns.begin(), from.offset_ns.end());
}

}  // namespace

int main() {
  set_float_mode();
  client::Client plumbline;
  const auto method = slam::find_method("vgicp")->make(input_of(read_json(plumbline.hello(), "HELLO")));
  slam::Scan copy;
  while (const client::Scan* scan = plumbline.next()) {
    for (const auto& odometry : scan->odometry) method->on_odometry({odometry.stamp_ns, pose_of(odometry.X_OR)});
    copy_scan(*scan, copy);
    const slam::Output output = method->on_scan(copy);
    plumbline.answer(wire_of(*output.X_FR), static_cast<int>(output.state));
  }
  std::vector<client::StampedPose> trajectory;
  for (const auto& pose : method->finish().trajectory) trajectory.push_back({pose.stamp, wire_of(pose.X_FR)});
  plumbline.finish(trajectory, {});
}
