// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "bim/config/tree.h"
#include "scenarios/report/report.h"
#include "scenarios/run/finished_run.h"

namespace plumbline::scenarios {

/// Numbers of the replay page are whole multiples of a unit; a column of them holds differences to the value before.
[[nodiscard]] Tree whole(double value, double unit);
class DeltaColumn {
 public:
  explicit DeltaColumn(double unit) : unit_(unit) {}
  void add(double value);
  [[nodiscard]] Tree take() { return std::move(list_); }

 private:
  double unit_;
  std::int64_t before_ = 0;
  Tree list_ = Tree::list();
};

/// What everything on the page is relative to, so that single precision does: the middle of the building, whole metres.
[[nodiscard]] Eigen::Vector3d replay_origin(const FinishedRun& run);

/// Storeys, rooms, the plan's faces, elements of the mesh, deviations; lengths in mm relative to `origin`.
[[nodiscard]] Tree replay_scene(const FinishedRun& run, const ReportInput& input, const Eigen::Vector3d& origin);

/// The as-built mesh: vertices as f32 x, y, z, then triangles as u32 a, b, c; little endian.
[[nodiscard]] std::string replay_mesh(const FinishedRun& run, const Eigen::Vector3d& origin);

}  // namespace plumbline::scenarios
