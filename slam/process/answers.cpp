// SPDX-License-Identifier: Apache-2.0
#include "slam/process/answers.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "bim/config/tree.h"
#include "bim/geometry/symmetric.h"
#include "slam/io/pose_check.h"
#include "slam/process/child.h"
#include "slam/process/client/plumbline_messages.h"
#include "slam/scan/map_cloud.h"

namespace plumbline::slam {

namespace {

constexpr std::uint32_t max_particles = 500;
constexpr std::uint64_t max_poses = 10'000'000;
constexpr double farthest_ns = 1e18;

/// Takes values off the front of a payload.
class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <class T>
  T take() {
    T value;
    const std::span<const std::byte> from = take_bytes(sizeof(T));
    std::memcpy(&value, from.data(), sizeof(T));
    return value;
  }
  std::span<const std::byte> take_bytes(std::size_t size) {
    if (size > bytes_.size()) throw ProcessFailure("is shorter than it says");
    const std::span<const std::byte> front = bytes_.first(size);
    bytes_ = bytes_.subspan(size);
    return front;
  }
  void expect_left(std::uint64_t size) const {
    if (bytes_.size() != size)
      throw ProcessFailure("has " + std::to_string(bytes_.size()) + " bytes left where " + std::to_string(size) +
                           " should follow");
  }

 private:
  std::span<const std::byte> bytes_;
};

Pose pose_of(const wire::Pose& wire, const char* what) {
  constexpr double norm_tolerance = 1e-6;
  Eigen::Quaterniond q(wire.q[3], wire.q[0], wire.q[1], wire.q[2]);
  const Pose X{q, {wire.t[0], wire.t[1], wire.t[2]}};
  if (!plausible(X) || std::abs(q.norm() - 1.0) > norm_tolerance)
    throw ProcessFailure(std::string(what) +
                         " is none: finite coordinates of at most 100,000 km and a quaternion of norm 1 within 1e-6");
  constexpr double exact = 1e-15;  // what was computed by us comes back to the bit
  if (std::abs(q.norm() - 1.0) > exact) q.normalize();
  return {q, X.t};
}

Hypothesis hypothesis_of(const wire::Hypothesis& wire) {
  Hypothesis hypothesis;
  hypothesis.mass = wire.mass;
  hypothesis.X_WR = pose_of(wire.X_WR, "the pose of a hypothesis");
  const double* c = wire.covariance;
  hypothesis.covariance << c[0], c[1], c[2], c[1], c[3], c[4], c[2], c[4], c[5];
  if (!(wire.mass >= 0.0 && wire.mass <= 1.0)) throw ProcessFailure("has a mass that is no share");
  if (!hypothesis.covariance.allFinite()) throw ProcessFailure("has a covariance that is not finite");
  constexpr double rounding = 1e-9;  // of its largest entry
  if (symmetric_eigen(hypothesis.covariance).values[0] < -rounding * hypothesis.covariance.cwiseAbs().maxCoeff())
    throw ProcessFailure("has a covariance with a negative eigenvalue");
  return hypothesis;
}

Particle particle_of(const wire::Particle& wire) {
  for (const float value : {wire.x, wire.y, wire.yaw, wire.weight})
    if (!std::isfinite(value)) throw ProcessFailure("has a particle that is not finite");
  return {wire.x, wire.y, wire.yaw, wire.weight};
}

void check_masses(const std::vector<Hypothesis>& hypotheses) {
  constexpr double rounding = 1e-9;
  double sum = 0.0;
  for (const Hypothesis& hypothesis : hypotheses) sum += hypothesis.mass;
  if (sum > 1.0 + rounding) throw ProcessFailure("has masses of more than 1 together");
}

}  // namespace

Output read_output(std::span<const std::byte> payload, Nanoseconds stamp, bool localization) {
  Reader reader(payload);
  const auto head = reader.take<wire::Output>();
  if (head.stamp_ns != stamp)
    throw ProcessFailure("is for the time " + std::to_string(head.stamp_ns) + " ns, not " + std::to_string(stamp));
  if (head.state > 3) throw ProcessFailure("has the state " + std::to_string(head.state) + "; 0 to 3 are known");
  if (head.has_pose > 1) throw ProcessFailure("has has_pose " + std::to_string(head.has_pose) + "; 0 or 1 is known");
  if (head.particles > max_particles) throw ProcessFailure("has more than 500 particles");
  if (head.hypotheses > 0 && !localization)
    throw ProcessFailure(
        "has hypotheses, which only a localization in a plan has: say plan: true in the scenario, or --plan");
  reader.expect_left(head.hypotheses * sizeof(wire::Hypothesis) + head.particles * sizeof(wire::Particle));
  Output output;
  output.stamp = stamp;
  output.state = static_cast<State>(head.state);
  if (head.has_pose == 1) output.X_FR = pose_of(head.X_FR, "the pose");
  for (int i = 0; i < head.hypotheses; ++i) output.hypotheses.push_back(hypothesis_of(reader.take<wire::Hypothesis>()));
  for (std::uint32_t i = 0; i < head.particles; ++i)
    output.particles.push_back(particle_of(reader.take<wire::Particle>()));
  check_masses(output.hypotheses);
  return output;
}

Estimate read_estimate(std::span<const std::byte> payload, bool localization, bool strict) {
  Reader reader(payload);
  const auto head = reader.take<wire::Estimate>();
  if (head.json_bytes > wire::max_payload || head.poses > max_poses || head.points > wire::max_payload)
    throw ProcessFailure("has more poses or points than fit");
  reader.expect_left(head.json_bytes + head.poses * sizeof(wire::Odometry) + head.points * 3 * sizeof(float));
  if (strict && head.json_bytes > 0)
    throw ProcessFailure("has " + std::to_string(head.json_bytes) + " reserved bytes, which nobody reads; say 0");
  static_cast<void>(reader.take_bytes(head.json_bytes));
  Estimate estimate;
  estimate.frame = localization ? Frame::world : Frame::map;
  Nanoseconds before = std::numeric_limits<Nanoseconds>::min();
  for (std::uint64_t i = 0; i < head.poses; ++i) {
    const auto pose = reader.take<wire::Odometry>();
    if (std::abs(static_cast<double>(pose.stamp_ns)) > farthest_ns)
      throw ProcessFailure("has a pose at " + std::to_string(pose.stamp_ns) + " ns, thirty years from the recording");
    if (pose.stamp_ns <= before) throw ProcessFailure("has a trajectory whose times do not grow");
    before = pose.stamp_ns;
    estimate.trajectory.push_back({pose.stamp_ns, pose_of(pose.X_OR, "a pose of the trajectory")});
  }
  for (std::uint64_t i = 0; i < head.points; ++i) {
    const auto x = reader.take<float>(), y = reader.take<float>(), z = reader.take<float>();
    const Eigen::Vector3f p(x, y, z);
    if (!p.allFinite()) throw ProcessFailure("has a point of the map that is not finite");
    if (p.norm() > farthest_map_point_m)
      throw ProcessFailure("has a point of the map farther than 50 km from the origin");
    estimate.map_F.push_back(p);
  }
  estimate.map_F = thin_map(estimate.map_F);
  return estimate;
}

}  // namespace plumbline::slam
