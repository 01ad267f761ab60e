// SPDX-License-Identifier: Apache-2.0
#include "slam/io/recordings/recording_info.h"

#include <algorithm>
#include <cmath>

#include "slam/io/pose_check.h"

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
  const auto& position = info.mount.position_m;
  const bool on_robot = std::ranges::all_of(position, [](double v) { return std::abs(v) <= 100.0; });
  if (position.size() != 3 || !on_robot)
    throw InputError(mark, "position_m must be 3 numbers, at most 100 m each: [x, y, z]");
  if (info.mount.quaternion_xyzw.size() != 4) throw InputError(mark, "quaternion_xyzw must be 4 numbers: [x, y, z, w]");
  static_cast<void>(checked_pose(Eigen::Vector3d(position.data()), quaternion(info.mount.quaternion_xyzw), mark));
  return info;
}

std::string write_recording_info(const RecordingInfo& info) { return write_yaml(to_tree(info)); }

Calibration calibration_of(const RecordingInfo& info) {
  Calibration calibration;
  calibration.X_RL =
      checked_pose(Eigen::Vector3d(info.mount.position_m.data()), quaternion(info.mount.quaternion_xyzw), {});
  if (info.mount.height_m) calibration.sensor_height_m = *info.mount.height_m;
  return calibration;
}

Prior prior_of(const RecordingInfo& info) {
  Prior prior;
  prior.yaw_W = info.prior.yaw_rad;
  prior.yaw_sigma = info.prior.yaw_sigma_rad;
  prior.storey = info.prior.storey;
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
  info.prior.yaw_rad = prior.yaw_W;
  info.prior.yaw_sigma_rad = prior.yaw_sigma;
  info.prior.storey = prior.storey;
  return info;
}

}  // namespace plumbline::slam
