// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenarios/run/record.h"

namespace plumbline::scenarios {

/// <method>.estimate.json: frame, whether and why it crashed, scans, after how many it was lost, how many were
/// degenerate, stamps of the first and last scan of each time it was lost (lost_ns: [[from, to], ...]), planes, rooms,
/// floors. Trajectories and the map stand in files of their own.
[[nodiscard]] std::string write_estimate(const MethodRecord& method);
/// Sets what write_estimate wrote. Throws InputError.
void read_estimate(std::string_view text, const std::string& file, MethodRecord& method);

/// <method>.hypotheses.jsonl: a line a scan {stamp_ns, state, hypotheses: [{mass, room, pose, covariance, walls: [{
/// faces, p0, p1}]}], particles: [[x, y, yaw, weight]]}; pose is [x, y, z, qx, qy, qz, qw] of X_WR; walls, where there
/// are any, are patches p0 to p1 in R and the ids of the plan's faces they were taken for; they and particles are
/// rounded to 1 mm and 1 mrad.
[[nodiscard]] std::string write_beliefs(const std::vector<BeliefRecord>& beliefs);
[[nodiscard]] std::vector<BeliefRecord> read_beliefs(std::string_view text, const std::string& file);

}  // namespace plumbline::scenarios
