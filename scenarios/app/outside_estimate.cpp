// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/outside_estimate.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "bim/config/tree.h"
#include "scenarios/app/estimate_score.h"
#include "scenarios/host/files.h"
#include "scenarios/host/manifest.h"
#include "scenarios/metrics/quaternion_order.h"
#include "scenarios/metrics/time_shift.h"
#include "scenarios/metrics/trajectory.h"
#include "scenarios/run/ground_truth_recorder.h"
#include "scenarios/run/run_files.h"
#include "scenarios/spec/method_names.h"
#include "slam/io/bags/bag.h"
#include "slam/io/bags/bag_poses.h"
#include "slam/io/recordings/trajectory.h"
#include "slam/io/recordings/tum.h"
#include "slam/io/second.h"

namespace plumbline::scenarios {

namespace {

Mark mark() { return {"--estimate", 0, 0}; }

bool is_plain_name(const std::string& label) {
  const std::string name = choice_of(label).method;
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return !name.empty() && std::all_of(name.begin(), name.end(), plain);
}

/// An estimate of another run of the same length would pass for a bad one.
void check_walk(const std::string& dir, const std::string& run_dir, const FinishedRun& run) {
  const std::string path = dir + "/estimate.yaml";
  const Tree tree = read_yaml(read_text_file(path), path);
  const Tree* walk = tree.find("walk");
  if (walk != nullptr && walk->as_string() != sensor_digest_of(run.record.digests))
    throw InputError(walk->mark, "the estimate is of another run's recording; give one of " + run_dir);
}

/// What `plumbline estimate` left: planes, rooms and map beside the trajectories.
Outside read_estimate_directory(const std::string& dir, const std::string& name, const std::string& run_dir,
                                const FinishedRun& run, bool unchecked) {
  const std::vector<std::string> methods = estimates_in(dir);
  if (methods.size() != 1)
    throw InputError({dir, 0, 0}, methods.empty() ? "holds no estimate; give what plumbline estimate wrote"
                                                  : "holds several estimates; give a directory of plumbline estimate");
  const std::vector<std::string> altered = altered_files(dir, {derived_files(), false, DirectoryKind::estimate});
  refuse_altered(dir, altered, unchecked);
  if (std::filesystem::exists(dir + "/estimate.yaml")) check_walk(dir, run_dir, run);
  Outside outside{read_method(dir, methods.front()), {}, {}};
  outside.method.name = name;
  for (const std::string& file : altered) outside.altered.push_back(name + "=" + file);
  for (const std::string& file : unchecked_by_estimate(dir)) outside.altered.push_back(name + "=recording/" + file);
  return outside;
}

/// NAME=PATH and the options after it.
struct Given {
  std::string name, path;
  bool world = false;
  std::string topic;  ///< of a bag
  std::string shift;  ///< seconds, or auto
};

/// The options may stand in any order; a path may hold commas.
Given parse(const std::string& text) {
  const std::size_t equals = text.find('=');
  Given given;
  given.name = text.substr(0, equals);
  given.path = equals == std::string::npos ? "" : text.substr(equals + 1);
  std::string frame;
  for (std::size_t comma; (comma = given.path.rfind(',')) != std::string::npos;) {
    const std::string option = given.path.substr(comma + 1), key = option.substr(0, option.find('='));
    std::string* value = key == "frame"   ? &frame
                         : key == "topic" ? &given.topic
                         : key == "shift" ? &given.shift
                                          : nullptr;
    if (value == nullptr || key == option) break;
    if (!value->empty()) throw InputError(mark(), "'" + text + "' has " + key + " twice");
    *value = option.substr(key.size() + 1);
    if (value->empty()) throw InputError(mark(), "'" + key + "=' must have a value");
    given.path.resize(comma);
  }
  if (!frame.empty() && frame != "W" && frame != "M")
    throw InputError(mark(), "'frame=" + frame + "' must be frame=W, the plan's, or frame=M, its own");
  given.world = frame == "W";
  if (!is_plain_name(given.name) || given.path.empty())
    throw InputError(mark(), "'" + text + "' must be NAME=FILE, NAME=FILE,frame=W or NAME=directory of estimate");
  return given;
}

score::Truth truth_of(const FinishedRun& run) {
  score::Truth truth;
  truth.scans = run.scans;
  truth.poses_W = run.record.truth_W;
  return truth;
}

/// A trajectory on another clock, the commonest mistake, would pass for a lost one.
void check_stamps(const std::string& text, const MethodRecord& method, const FinishedRun& run) {
  if (method.causal.empty() || !score::associate(truth_of(run), method.causal, {}).empty()) return;
  const auto span = [](slam::Nanoseconds first, slam::Nanoseconds last) {
    return slam::format_stamp(first) + " to " + slam::format_stamp(last) + " s";
  };
  throw InputError(mark(), "'" + text + "' has a pose within 0.01 s of none of the run's scans; it is of " +
                               span(method.causal.front().stamp, method.causal.back().stamp) + ", the scans are of " +
                               span(run.scans.front(), run.scans.back()) +
                               "; shift=auto finds what is between two clocks");
}

/// Adds what `shift` says to the stamps; returns what was found.
std::string apply_shift(const Given& given, MethodRecord& method, const FinishedRun& run) {
  std::vector<slam::StampedPose>& poses = method.causal;
  if (given.shift.empty()) return {};
  std::optional<slam::Nanoseconds> shift;
  if (given.shift == "auto") {
    shift = score::find_shift(truth_of(run), poses);
    if (!shift)
      throw InputError({given.path, 0, 0},
                       "shift=auto finds no single time at which its motion is that of the run; give shift=SECONDS");
  } else if (slam::Nanoseconds seconds = 0; slam::parse_stamp(given.shift, seconds)) {
    shift = seconds;
  } else {
    throw InputError(mark(), "'shift=" + given.shift + "' must be auto, or seconds that are added to the stamps");
  }
  for (slam::StampedPose& pose : poses) {
    if (std::abs(pose.stamp + *shift) >= slam::furthest_stamp)  // as both are less, the sum fits
      throw InputError(mark(), "'shift=" + given.shift + "' makes stamps of " + slam::format_stamp(pose.stamp) +
                                   " s too large; they are less than 4e9 s");
    pose.stamp += *shift;
  }
  method.shift = *shift;
  if (given.shift != "auto") return {};
  return given.name + ": " + slam::format_stamp(*shift) + " s added to its stamps, by its motion (shift=auto)\n";
}

std::vector<slam::StampedPose> read_poses(const Given& given, const FinishedRun& run) {
  if (!given.topic.empty()) {
    if (slam::is_bag(given.path)) return slam::read_bag_poses(given.path, given.topic);
    throw InputError({given.path, 0, 0}, "is no bag, and 'topic' is of one");
  }
  if (slam::is_bag(given.path))
    throw InputError({given.path, 0, 0},
                     "is a bag; name the topic of its poses: " + given.name + "=" + given.path + ",topic=/TOPIC");
  const std::string text = read_text_file(given.path);
  std::vector<slam::StampedPose> poses = slam::read_trajectory(text, given.path, run.scans);
  if (poses.empty()) throw InputError({given.path, 0, 0}, "holds no pose");
  return poses;
}

}  // namespace

Outside read_outside(const std::string& text, const std::string& run_dir, const FinishedRun& run, bool unchecked) {
  const Given given = parse(text);
  if (std::filesystem::is_directory(given.path) && !slam::is_bag(given.path)) {
    if (given.world || !given.topic.empty() || !given.shift.empty())
      throw InputError(mark(), "'" + text + "': frame, topic and shift are of a file, not of a directory of estimate");
    return read_estimate_directory(given.path, given.name, run_dir, run, unchecked);
  }
  Outside outside;
  MethodRecord& method = outside.method;
  method.name = given.name;
  method.localization = given.world;
  method.estimate.frame = given.world ? slam::Frame::world : slam::Frame::map;
  method.causal = read_poses(given, run);
  outside.said = apply_shift(given, method, run);
  check_stamps(text, method, run);
  if (given.topic.empty())
    if (const std::string why =
            score::wrong_order(slam::trajectory_form(read_text_file(given.path)), method.causal, truth_of(run));
        !why.empty())
      throw InputError({given.path, 0, 0}, why);
  return outside;
}

}  // namespace plumbline::scenarios
