// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scenarios/host/files.h"
#include "scenarios/run/run_files.h"
#include "tests/folder.h"

/// What tests that read a directory of `plumbline estimate` begin with.
namespace plumbline::scenarios {

inline constexpr slam::Nanoseconds tenth_ns = 100'000'000;

/// Poses 0.1 s and 0.1 m apart on a bend.
inline std::vector<slam::StampedPose> poses_on_a_bend(int poses, slam::Nanoseconds from = 0) {
  std::vector<slam::StampedPose> path;
  Pose X;
  for (int i = 0; i < poses; ++i) {
    path.push_back({from + i * tenth_ns, X});
    X = X * Pose::from_xyz_yaw({0.1, 0.0, 0.0}, 0.05);
  }
  return path;
}

inline MethodRecord method_on_a_bend(int poses, slam::Nanoseconds from = 0) {
  MethodRecord method;
  method.name = "kiss_icp";
  method.scans = poses;
  method.causal = poses_on_a_bend(poses, from);
  return method;
}

/// Writes a directory whose digests are at `ticks` and whose origin is not known.
inline void write_estimate(const std::string& dir, const MethodRecord& method,
                           const std::vector<slam::Nanoseconds>& ticks) {
  write_method(dir, method);
  write_file(dir + "/estimate.yaml", "estimate: 1\nmethod: " + method.name + "\nseed: 1\n");
  DigestLog digests;
  for (const slam::Nanoseconds tick : ticks) digests.push_back({tick, "slam." + method.name, 1});
  write_file(dir + "/digests.csv", write_digests(digests));
}

}  // namespace plumbline::scenarios
