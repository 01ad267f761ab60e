// SPDX-License-Identifier: Apache-2.0
#include "slam/io/recording_info.h"

#include <cmath>

namespace plumbline::slam {

namespace {

Eigen::Quaterniond quaternion(const std::vector<double>& xyzw) { return {xyzw[3], xyzw[0], xyzw[1], xyzw[2]}; }

}  // namespace

RecordingInfo read_recording_info(std::string_view text, const std::string& file) {
  const Tree tree = read_yaml(text, file);
  if (!tree.is_map() || tree.as_map().empty() || tree.as_map().front().first != "recording")
    throw InputError({file, 1, 1}, "the first key of a recording's description must be 'recording: 1'");
  auto info = from_tree<RecordingInfo>(tree);
  const Tree* mount = tree.find("mount");
  const Mark mark = mount != nullptr ? mount->mark : tree.mark;
  if (info.mount.position_m.size() != 3) throw InputError(mark, "position_m must be 3 numbers: [x, y, z]");
  if (info.mount.quaternion_xyzw.size() != 4) throw InputError(mark, "quaternion_xyzw must be 4 numbers: [x, y, z, w]");
  const double norm = quaternion(info.mount.quaternion_xyzw).norm();
  if (!(std::abs(norm - 1.0) <= 0.01))
    throw InputError(mark, "the quaternion's norm is " + format_number(norm) + ", not 1");
  return info;
}

std::string write_recording_info(const RecordingInfo& info) { return write_yaml(to_tree(info)); }

Calibration calibration_of(const RecordingInfo& info) {
  Calibration calibration;
  calibration.X_RL.t = Eigen::Vector3d(info.mount.position_m.data());
  calibration.X_RL.q = quaternion(info.mount.quaternion_xyzw);
  // Only where it is needed, so that what the simulator wrote comes back to the bit.
  if (std::abs(calibration.X_RL.q.norm() - 1.0) > 1e-9) calibration.X_RL.q.normalize();
  calibration.sensor_height_m = info.mount.height_m;
  return calibration;
}

Prior prior_of(const RecordingInfo& info) {
  Prior prior;
  prior.yaw_W = info.told.yaw_rad;
  prior.yaw_sigma = info.told.yaw_sigma_rad;
  prior.storey = info.told.storey;
  return prior;
}

RecordingInfo recording_info(std::uint64_t seed, const Calibration& calibration, const Prior& prior) {
  const Eigen::Vector3d& t = calibration.X_RL.t;
  const Eigen::Quaterniond& q = calibration.X_RL.q;
  RecordingInfo info;
  info.seed = seed;
  info.mount.position_m = {t.x(), t.y(), t.z()};
  info.mount.quaternion_xyzw = {q.x(), q.y(), q.z(), q.w()};
  info.mount.height_m = calibration.sensor_height_m;
  info.told.yaw_rad = prior.yaw_W;
  info.told.yaw_sigma_rad = prior.yaw_sigma;
  info.told.storey = prior.storey;
  return info;
}

}  // namespace plumbline::slam
