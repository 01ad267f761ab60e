// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scenarios/metrics/silence.h"
#include "scenarios/run/digest_log.h"
#include "scenarios/spec/scenario.h"
#include "slam/io/estimate.h"

namespace plumbline::scenarios {

/// What a method said after one scan, as kept for scoring and the report.
struct BeliefRecord {
  slam::Nanoseconds stamp = 0;
  slam::State state = slam::State::searching;
  std::vector<slam::Hypothesis> hypotheses;  ///< their walls as particles are
  std::vector<slam::Particle> particles;     ///< of the scans where the state changed, and one a second
};

/// CPU times of the calls of one stage, ms, in call order.
struct StageTimes {
  std::string stage;
  std::vector<float> cpu_ms;
};

/// Adds one call to the times of its stage, which is appended where it is new.
void add_time(std::vector<StageTimes>& times, const slam::StageTime& call);

/// Everything one method left behind.
struct MethodRecord {
  std::string name;
  bool crashed = false;
  std::string error;                      ///< why it crashed
  bool localization = false;              ///< answers in W and is scored as a plan localization
  int scans = 0;                          ///< it was given; 0 of an outside trajectory, of which that is not known
  int lost_scans = 0;                     ///< of these, after how many it said that it is lost
  int degenerate_scans = 0;               ///< and how many left a direction of the pose open
  std::vector<score::LostSpan> lost;      ///< when it was lost
  std::vector<slam::StampedPose> causal;  ///< each pose as first given
  std::vector<BeliefRecord> beliefs;      ///< of plan localization: one a scan
  slam::Estimate estimate;
  std::vector<GateSpec> gates;  ///< of an outside estimate: asked of it in place of the scenario's
  slam::Nanoseconds shift = 0;  ///< of an outside estimate: added to its stamps
  DigestLog digests;
  std::vector<StageTimes> times;
};

/// Whether a method said after a scan that it is lost: its pose there is no answer.
[[nodiscard]] bool said_lost(const MethodRecord& method, slam::Nanoseconds stamp);

/// Moves all times of what a method answered, those of its graph included.
void shift_times(MethodRecord& method, slam::Nanoseconds by);

/// Everything one run left behind, the ground truth with it, which is for scoring alone.
struct RunRecord {
  std::vector<slam::StampedPose> truth_W;  ///< X_WR, 100 Hz and at every scan
  std::vector<Eigen::Vector3f> surface_W;  ///< as-built points hit by true returns, one a 0.1 m voxel
  std::vector<MethodRecord> methods;       ///< in the scenario's order
  DigestLog digests;                       ///< of all stages
  std::vector<StageTimes> sim_times;
  std::string failure;  ///< why the scenario ended early: a fall or a stall; else empty
};

}  // namespace plumbline::scenarios
