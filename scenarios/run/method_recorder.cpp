// SPDX-License-Identifier: Apache-2.0
#include "scenarios/run/method_recorder.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "bim/config/utf8.h"
#include "bim/digest/digest.h"
#include "bim/errors.h"
#include "scenarios/run/as_written.h"
#include "slam/io/pose_check.h"
#include "slam/io/stopwatch.h"
#include "slam/process/shortened.h"

namespace plumbline::scenarios {

namespace {

/// Particle sets and matched walls are large: between changes of the state one is kept every so often.
constexpr slam::Nanoseconds detail_interval = 1'000'000'000;
/// Results, reports and terminals show why a method crashed.
constexpr std::size_t longest_error = 5000;

Digest& add_pose(Digest& digest, const std::optional<Pose>& X) {
  digest.add(X ? 1 : 0);
  return X ? digest.add(*X) : digest;
}

std::uint64_t digest_of(const slam::Output& output) {
  Digest digest;
  digest.add(output.stamp).add(static_cast<int>(output.state));
  add_pose(digest, output.X_FR);
  for (const slam::Hypothesis& hypothesis : output.hypotheses) {
    digest.add(hypothesis.mass).add(hypothesis.X_WR).add(std::string_view(hypothesis.room));
    digest.add(std::span<const double>(hypothesis.covariance.data(), 9));
  }
  return digest.value();
}

std::uint64_t digest_of(const slam::Estimate& estimate) {
  Digest digest;
  digest.add(static_cast<int>(estimate.frame));
  for (const slam::StampedPose& pose : estimate.trajectory) digest.add(pose.stamp).add(pose.X_FR);
  for (const slam::PlaneNode& plane : estimate.planes)
    digest.add(plane.id).add(plane.plane_F).add(plane.p0).add(plane.p1).add(plane.z0).add(plane.z1);
  for (const slam::RoomNode& room : estimate.rooms) {
    digest.add(room.id).add(static_cast<int>(room.kind)).add(room.center_F);
    for (const Eigen::Vector2d& p : room.polygon_F) digest.add(p);
    for (const int plane : room.planes) digest.add(plane);
  }
  for (const slam::FloorNode& floor : estimate.floors) digest.add(floor.id).add(floor.center_F).add(floor.plane_F);
  for (const Eigen::Vector3f& p : estimate.map_F) digest.add(Eigen::Vector3d(p.cast<double>()));
  return digest.value();
}

/// A pose that could not be read back from the files of a run is refused.
void check(const Pose& X_FR) {
  if (!slam::plausible(X_FR))
    throw InternalError(
        "gave an invalid pose: more than 100,000 km from the origin, or a quaternion that is not of norm 1");
}

}  // namespace

MethodRecorder::MethodRecorder(std::string name, bool localization) {
  record_.name = std::move(name);
  record_.localization = localization;
}

void MethodRecorder::on_scan(slam::Nanoseconds stamp, const std::function<slam::Output()>& process) {
  if (record_.crashed) return;
  last_stamp_ = stamp;
  try {
    keep(process());
  } catch (const std::exception& error) {
    record_.crashed = true;
    record_.error = slam::shortened(utf8_of_bytes(error.what()), longest_error);
  }
}

void MethodRecorder::keep(const slam::Output& output) {
  if (output.X_FR) check(*output.X_FR);
  for (const slam::Hypothesis& hypothesis : output.hypotheses) check(hypothesis.X_WR);
  if (record_.localization) check_finite(BeliefRecord{output.stamp, output.state, output.hypotheses, output.particles});
  ++record_.scans;
  keep_lost(output);
  if (output.degenerate_directions > 0) ++record_.degenerate_scans;
  const auto log = [&](const std::string& stage, std::uint64_t digest) {
    record_.digests.push_back({last_stamp_, record_.name + "/" + stage, digest});
  };
  for (const slam::StageDigest& stage : output.digests) log(stage.stage, stage.digest);
  log("output", digest_of(output));
  if (output.X_FR) record_.causal.push_back({output.stamp, *output.X_FR});
  if (record_.localization) keep_belief(output);
  for (const slam::StageTime& time : output.times) add_time(record_.times, time);
}

void MethodRecorder::keep_lost(const slam::Output& output) {
  const bool was_lost = std::exchange(lost_, output.state == slam::State::lost);
  if (!lost_) return;
  ++record_.lost_scans;
  if (!was_lost) record_.lost.push_back({last_stamp_, last_stamp_});
  record_.lost.back().to = last_stamp_;
}

void MethodRecorder::keep_belief(const slam::Output& output) {
  const bool first = record_.beliefs.empty();
  const bool changed = first || record_.beliefs.back().state != output.state;
  BeliefRecord belief{output.stamp, output.state, output.hypotheses, {}};
  if (!output.particles.empty() && (changed || output.stamp - particles_stamp_ >= detail_interval)) {
    belief.particles = output.particles;
    particles_stamp_ = output.stamp;
  }
  const bool has_walls = std::any_of(output.hypotheses.begin(), output.hypotheses.end(),
                                     [](const slam::Hypothesis& hypothesis) { return !hypothesis.walls.empty(); });
  if (has_walls && (changed || output.stamp - walls_stamp_ >= detail_interval))
    walls_stamp_ = output.stamp;
  else
    for (slam::Hypothesis& hypothesis : belief.hypotheses) hypothesis.walls.clear();
  record_.beliefs.push_back(std::move(belief));
}

MethodRecord MethodRecorder::finish(const std::function<slam::Estimate()>& estimate) {
  if (!record_.crashed) {
    try {
      const slam::Stopwatch watch;
      slam::Estimate answer = estimate();
      for (const slam::StampedPose& pose : answer.trajectory) check(pose.X_FR);
      check_finite(answer);
      record_.estimate = std::move(answer);
      if (!record_.times.empty()) add_time(record_.times, {"finish", watch.cpu_ms()});
      record_.digests.push_back({last_stamp_, record_.name + "/estimate", digest_of(record_.estimate)});
    } catch (const std::exception& error) {
      record_.crashed = true;
      record_.error = slam::shortened(utf8_of_bytes(error.what()), longest_error);
    }
  }
  return std::move(record_);
}

}  // namespace plumbline::scenarios
