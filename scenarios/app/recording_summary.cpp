// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/recording_summary.h"

#include <algorithm>
#include <utility>

#include "bim/config/printable.h"

namespace plumbline::scenarios {

namespace {

std::string list_of(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

}  // namespace

void ScansRead::add(const slam::Scan& scan) {
  ++count;
  if (std::none_of(scan.range_m.begin(), scan.range_m.end(), [](double range) { return range > 0.0; })) {
    ++empty;
    return;
  }
  rings = std::max(rings, scan.rings);
  timed = timed || std::any_of(scan.offset_ns.begin(), scan.offset_ns.end(), [](auto ns) { return ns != 0; });
}

std::string words_of(const slam::Taken& taken, const ScansRead& scans, bool has_odometry) {
  std::string text = taken.points;
  if (!taken.other_points.empty()) text += " (not " + list_of(taken.other_points) + ")";
  text += (text.empty() ? "" : ": ") + std::to_string(scans.count) + " scans, ";
  text += scans.rings > 1 ? std::to_string(scans.rings) + " rings, " : "no rings, ";
  text += scans.timed ? "points with times" : "points without times";
  if (!taken.frame.empty()) text += "; frame " + taken.frame;
  switch (taken.mount) {
    case slam::MountSource::description:
      text += "; mount from the description";
      break;
    case slam::MountSource::tf_static:
      text += "; mount from /tf_static";
      break;
    case slam::MountSource::tf:
      text += "; mount from /tf, where it never moves";
      break;
    case slam::MountSource::same_frame:
      text += ", which is the robot's, so that no mount is needed";
      break;
    case slam::MountSource::unknown:
      text += "; no mount, so that the robot's frame is the LiDAR's";
  }
  text += has_odometry ? "; odometry " + taken.odometry : "; no odometry";
  if (has_odometry && !taken.robot.empty()) text += " of " + taken.robot;
  if (!taken.imu.empty()) text += "; IMU " + taken.imu;
  while (text.ends_with(' ')) text.pop_back();
  return printable(text);
}

Tree to_tree(const slam::Taken& taken, const ScansRead& scans) {
  Tree tree = Tree::map();
  if (!taken.points.empty()) tree.set("points", taken.points);
  Tree others = Tree::list();
  for (const std::string& name : taken.other_points) others.push(name);
  if (!taken.other_points.empty()) tree.set("other_points", std::move(others));
  if (!taken.odometry.empty()) tree.set("odometry", taken.odometry);
  if (!taken.imu.empty()) tree.set("imu", taken.imu);
  if (!taken.frame.empty()) tree.set("frame", taken.frame);
  if (!taken.robot.empty()) tree.set("robot", taken.robot);
  tree.set("mount", slam::names_of(taken.mount)[static_cast<std::size_t>(taken.mount)]);
  return tree.set("scans", scans.count).set("rings", scans.rings).set("point_times", scans.timed);
}

std::vector<std::string> warnings_of(const slam::Recording& recording) {
  std::vector<std::string> all = recording.left_out();
  for (const std::string& said : recording.assumed()) all.push_back(said);
  const slam::Taken taken = recording.taken();
  if (recording.has_odometry() && taken.mount == slam::MountSource::unknown)
    all.push_back("where the LiDAR sits on the robot is not known; its frame" +
                  (taken.frame.empty() ? std::string() : " '" + taken.frame + "'") +
                  " is taken to be the robot's; --description gives the mount");
  return all;
}

}  // namespace plumbline::scenarios
