// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/estimate_reference.h"

#include <optional>
#include <string_view>
#include <utility>

#include "bim/config/input_file.h"
#include "bim/errors.h"
#include "scenarios/metrics/quaternion_order.h"
#include "scenarios/metrics/reference_score.h"
#include "slam/io/bags/bag.h"
#include "slam/io/bags/bag_poses.h"
#include "slam/io/recordings/trajectory.h"

namespace plumbline::scenarios {

namespace {

using ReferencePoses = std::vector<slam::StampedPose>;

ReferencePoses read_poses_of(const ReferenceSource& source, const ReferencePoses& estimate) {
  const std::string& file = source.file;
  const bool is_bag = slam::is_bag(file);
  if (is_bag && source.topic.empty())
    throw InputError({file, 0, 0}, "is a bag; name the topic of its poses: --reference " + file + ",topic=/TOPIC");
  if (!is_bag && !source.topic.empty()) throw InputError({file, 0, 0}, "is no bag, and 'topic' is of one");
  if (is_bag) return slam::read_bag_poses(file, source.topic);
  std::vector<slam::Nanoseconds> scans;
  for (const slam::StampedPose& pose : estimate) scans.push_back(pose.stamp);
  ReferencePoses poses = slam::read_trajectory(read_text_file(file), file, scans);
  if (poses.empty()) throw InputError({file, 0, 0}, "holds no pose");
  return poses;
}

void check_order(const ReferencePoses& poses, const ReferencePoses& reference, const ReferenceSource& source) {
  if (reference.empty() || !source.topic.empty()) return;
  const std::string& file = source.file;
  const slam::TrajectoryForm form = slam::trajectory_form(read_text_file(file));
  const auto as_read = score::score_by_reference(reference, poses);
  const auto other = score::score_by_reference(slam::in_other_order(reference, form), poses);
  const auto over_a_metre = [](const auto& by) { return by ? by->rpe_1m_rmse_m : std::nullopt; };
  if (const std::string why = score::wrong_order(form, over_a_metre(as_read), over_a_metre(other)); !why.empty())
    throw InputError({file, 0, 0}, why);
}

}  // namespace

ReferenceSource reference_source(std::string text) {
  ReferenceSource source;
  std::string frame;
  const auto take = [&](std::string_view key, std::string& value) {
    const std::size_t at = text.rfind(key);
    if (at == std::string::npos || text.find(',', at + 1) != std::string::npos) return false;
    if (!value.empty()) throw InputError({"--reference", 0, 0}, "has " + std::string(key.substr(1)) + " twice");
    value = text.substr(at + key.size());
    if (value.empty()) throw InputError({"--reference", 0, 0}, "has nothing behind " + std::string(key.substr(1)));
    text.resize(at);
    return true;
  };
  while (take(",topic=", source.topic) || take(",frame=", frame)) {
  }
  if (!frame.empty() && frame != "W" && frame != "M")
    throw InputError({"--reference", 0, 0}, "'frame=" + frame + "' must be W, the plan's frame, or M, any other");
  if (text.empty() && (!frame.empty() || !source.topic.empty()))
    throw InputError({"--reference", 0, 0}, "names no file");
  source.in_plan_frame = frame == "W";
  source.file = std::move(text);
  return source;
}

ReferencePoses read_reference(const ReferenceSource& source, const ReferencePoses& estimate) {
  ReferencePoses reference = read_poses_of(source, estimate);
  check_order(estimate, reference, source);
  return reference;
}

}  // namespace plumbline::scenarios
