// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "bim/config/tree.h"
#include "scenarios/report/report.h"
#include "scenarios/run/finished_run.h"
#include "scenarios/score/score_run.h"

namespace plumbline::scenarios {

/// Poses of the truth and of each method at the scans, as scored: SLAM aligned once over the whole run, localization as
/// it stands. Columns of differences: t (ms), x, y, z (mm), q (1e-5: x, y, z, w), e (error, 0.1 mm), lost (0 or 1).
[[nodiscard]] Tree replay_tracks(const FinishedRun& run, const score::RunScore& score, const Eigen::Vector3d& origin);

/// States, hypotheses with the walls matched (once a second and where the state changes) and particles of each plan
/// localization, by name.
[[nodiscard]] Tree replay_beliefs(const FinishedRun& run, const score::RunScore& score, const Eigen::Vector3d& origin);

/// X_WF of what a method made: by the alignment of its final trajectory; that of a localization is in W.
[[nodiscard]] Pose map_pose(const MethodRecord& method, const score::MethodScore& score);

/// The situational graph of the method, from its graph file, with the extents of its walls; null where it has none.
[[nodiscard]] Tree replay_graph(const MethodRecord& method, const score::MethodScore& score, const Tree& graph,
                                const Eigen::Vector3d& origin);

}  // namespace plumbline::scenarios
