// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/recording_doubts.h"

#include <optional>

namespace plumbline::scenarios {

void RecordingDoubts::add(const slam::SensorFrame& frame) {
  scans_.add(frame.scan);
  scan_gaps_.add(frame.scan.stamp);
  odometry_gaps_.add(frame);
  axes_.add(frame);
  clock_.add(frame);
  mount_.add(frame);
}

std::vector<std::string> RecordingDoubts::warnings(const MethodRecord& record, const Eigen::Quaterniond& mount_RL,
                                                   bool with_odometry) const {
  std::vector<std::string> all;
  const auto add = [&](const std::optional<std::string>& said) {
    if (said) all.push_back(*said);
  };
  add(scan_gaps_.warning());
  if (2 * scans_.empty > scans_.count)
    all.push_back(
        std::to_string(scans_.empty) + " of " + std::to_string(scans_.count) +
        " scans hold no return: their points are at the origin, farther than 1 km or no numbers, or there are none");
  if (!record.crashed && record.causal.empty())
    all.push_back("the method gave no pose at any of " + std::to_string(scans_.count) + " scans");
  std::vector<slam::StampedPose> known;
  for (const slam::StampedPose& pose : record.causal)
    if (!said_lost(record, pose.stamp)) known.push_back(pose);
  add(mount_.warning(known, mount_RL));
  if (!with_odometry) return all;
  for (const std::string& said : axes_.warnings()) all.push_back(said);
  add(clock_.warning());
  add(odometry_gaps_.warning());
  return all;
}

}  // namespace plumbline::scenarios
