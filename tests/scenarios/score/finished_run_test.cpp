// SPDX-License-Identifier: Apache-2.0
// Scores of a run that has just ended are those of its directory, to the byte.
#include "scenarios/run/finished_run.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <vector>

#include "bim/digest/digest.h"
#include "scenarios/report/report_builder.h"
#include "scenarios/run/run_files.h"
#include "scenarios/run/runner.h"
#include "scenarios/score/score_run.h"
#include "tests/data.h"
#include "tests/folder.h"

namespace plumbline::scenarios {
namespace {

class FinishedRunTest : public testing::Test {
 protected:
  static ResolvedScenario short_run() { return resolve(project_file("tests/system/short.yaml"), {}); }

  const Folder folder_;
};

TEST_F(FinishedRunTest, ScoresAndReportAreThoseOfItsDirectory) {
  const ResolvedScenario resolved = short_run();
  const RunRecord record = execute(resolved, {});
  ASSERT_FALSE(record.truth_W.empty()) << record.failure;
  write_run_files(folder_.path(), resolved, record);
  const FinishedRun ended = finished_run(resolved, record), read = read_run(folder_.path());
  const score::RunScore of_ended = score::score_run(ended), of_read = score::score_run(read);
  EXPECT_EQ(score::write_results(ended, of_ended), score::write_results(read, of_read));
  EXPECT_EQ(render_report(report_input(ended, of_ended)), render_report(report_input(read, of_read)));
}

TEST_F(FinishedRunTest, SaysHowFarTheBuildingWasMoved) {
  ResolvedScenario resolved = short_run();
  bim::Building building = resolved.building->as_planned();
  building.moved_by = Eigen::Vector3d(-487659, -5412349, 0);
  resolved.building = std::make_shared<const RunBuilding>(bim::PlannedAndBuilt{building, building, {}, true});
  const FinishedRun run = finished_run(resolved, execute(resolved, {}));
  const score::RunScore score = score::score_run(run);
  const Tree results = read_json(score::write_results(run, score), "results");
  ASSERT_NE(results.find("building"), nullptr);
  EXPECT_EQ(write_json(*results.find("building"), 0), "{\"moved_by_m\":[-487659,-5412349,0]}");
  EXPECT_NE(render_report(report_input(run, score)).find("building moved by -487659, -5412349, 0 m"),
            std::string::npos);
}

/// Everything that a file rounds: it must be rounded in memory alike.
TEST_F(FinishedRunTest, RecordsHaveThePrecisionOfTheirFiles) {
  const ResolvedScenario resolved = short_run();
  Pose X = Pose::from_xyz_yaw({1.0 / 3.0, -0.0, 0.5}, 0.7);
  X.q.coeffs() *= 1.0 + 1e-8;
  RunRecord record;
  record.truth_W = {{100, X}, {200, X}};
  record.surface_W = {{1.0F / 3.0F, 2.0F, -0.0F}};
  record.digests = {{200, "sim.lidar", 7}};
  MethodRecord& localizer = record.methods.emplace_back();
  localizer.name = "finder";
  localizer.localization = true;
  localizer.estimate.frame = slam::Frame::world;
  localizer.causal = localizer.estimate.trajectory = {{200, X}};
  localizer.estimate.map_F = {{0.1F, -0.0F, 0.3F}};
  localizer.estimate.graph = Tree::map().set("nodes", 1);
  localizer.estimate.planes = {{3, {{-0.0, 1.0, 0.0}, -0.0}, {1.0 / 3.0, -0.0}, {2.0, 1e-17}, -0.0, 2.5, 4}};
  localizer.estimate.rooms = {{1, slam::RoomKind::polygon, {-0.0, 0.1}, {{-0.0, 0.0}, {1.0 / 7.0, 0.0}}, {3}}};
  localizer.estimate.floors = {{0, {-0.0, 1.0, 2.0}, {{0.0, -0.0, 1.0}, -0.0}}};
  slam::Hypothesis hypothesis{1.0 / 3.0, X, Eigen::Matrix3d::Constant(-0.0), "hall", {}};
  hypothesis.walls = {{{1, 2}, {0.12345, -0.00001, 1.0}, {1.00049, 2.0, 3.0}}};
  localizer.beliefs = {{200, slam::State::ambiguous, {hypothesis}, {{0.12345, -0.00001, 3.14159, 0.1234567}}}};
  MethodRecord& oracle = record.methods.emplace_back();
  oracle.name = "truth";
  oracle.causal = {{200, X}};

  ResolvedScenario with_methods = resolved;
  with_methods.scenario.methods = {"finder", "truth"};
  with_methods.scenario.gates.clear();
  write_run_files(folder_.path(), with_methods, record);
  const FinishedRun ended = finished_run(with_methods, record);
  EXPECT_EQ(ended.scans, std::vector<slam::Nanoseconds>{200});
  for (const MethodRecord& method : ended.record.methods) {
    const MethodRecord read = read_method(folder_.path(), method.name);
    MethodRecord expected = read;
    if (is_oracle(expected)) give_truth(ended.record, expected);
    const auto digest = [](const MethodRecord& m) {
      Digest d;
      const auto add = [&](const std::vector<slam::StampedPose>& poses) {
        for (const slam::StampedPose& pose : poses) d.add(pose.stamp).add(pose.X_FR);
      };
      add(m.causal);
      add(m.estimate.trajectory);
      for (const slam::PlaneNode& p : m.estimate.planes)
        d.add(p.id).add(p.plane_F).add(p.p0).add(p.p1).add(p.z0).add(p.z1).add(p.observations);
      for (const slam::RoomNode& room : m.estimate.rooms) {
        d.add(room.id).add(room.center_F);
        for (const Eigen::Vector2d& p : room.polygon_F) d.add(p);
      }
      for (const slam::FloorNode& floor : m.estimate.floors) d.add(floor.center_F).add(floor.plane_F);
      for (const Eigen::Vector3f& p : m.estimate.map_F) d.add(Eigen::Vector3d(p.cast<double>()));
      for (const BeliefRecord& belief : m.beliefs) {
        d.add(belief.stamp).add(static_cast<int>(belief.state));
        for (const slam::Hypothesis& h : belief.hypotheses) {
          d.add(h.mass).add(h.X_WR).add(std::string_view(h.room)).add(std::span<const double>(h.covariance.data(), 9));
          for (const slam::WallMatch& wall : h.walls) d.add(wall.p0_R).add(wall.p1_R);
        }
        for (const slam::Particle& p : belief.particles) d.add(p.x).add(p.y).add(p.yaw).add(p.weight);
      }
      return d.value();
    };
    EXPECT_EQ(digest(method), digest(expected)) << method.name;
    EXPECT_EQ(method.estimate.graph.is_null(), true);
  }
}

/// A run whose files could not be written has no scores either, also where a sweep writes none.
TEST_F(FinishedRunTest, WhatFilesCannotHoldIsRefused) {
  const ResolvedScenario resolved = short_run();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  RunRecord record;
  record.truth_W = {{200, Pose()}};
  record.digests = {{200, "sim.lidar", 7}};
  const auto with = [&](auto&& change) {
    RunRecord changed = record;
    MethodRecord& method = changed.methods.emplace_back();
    method.name = "mapper";
    change(method);
    return changed;
  };
  const std::vector<RunRecord> refused = {
      with([&](MethodRecord& m) {
        m.estimate.map_F = {{0.0F, std::numeric_limits<float>::infinity(), 0.0F}};
      }),
      with([&](MethodRecord& m) {
        m.estimate.planes = {{0, {{1.0, 0.0, 0.0}, nan}, {0, 0}, {1, 0}, 0.0, 1.0, 1}};
      }),
      with([&](MethodRecord& m) {
        m.estimate.floors = {{0, {0.0, nan, 0.0}, {{0.0, 0.0, 1.0}, 0.0}}};
      }),
      with([&](MethodRecord& m) {
        m.localization = true;
        m.beliefs = {{200, slam::State::ambiguous, {{nan, Pose(), Eigen::Matrix3d::Zero(), "", {}}}, {}}};
      })};
  EXPECT_NO_THROW(static_cast<void>(finished_run(resolved, with([](MethodRecord&) {}))));
  for (const RunRecord& run : refused) {
    EXPECT_THROW(static_cast<void>(finished_run(resolved, run)), InternalError);
    EXPECT_THROW(write_run_files(folder_.path(), resolved, run), InternalError);
  }
}

}  // namespace
}  // namespace plumbline::scenarios
