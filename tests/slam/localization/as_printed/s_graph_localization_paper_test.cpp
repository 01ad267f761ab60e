// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/as_printed/s_graph_localization_paper.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bim/errors.h"
#include "bim/random/stream.h"
#include "tests/slam/baselines/plan_walk.h"
#include "tests/slam/localization/house_plan.h"
#include "tests/slam/localization/house_scan.h"
#include "tests/slam/planes/plane_forms.h"

namespace plumbline::slam {
namespace {

constexpr double pi = std::numbers::pi;

bim::Plan house_plan() { return synthetic::plan_of(synthetic::corridor_house()); }

PaperStorey storey_of(const bim::Plan& plan, PaperVariant faces) {
  PlanIndexConfig config;
  config.visibility_rays = 8;
  return make_paper_storey(plan, make_plan_index(plan, std::nullopt, config).storeys.front(), 1.0, faces);
}

Plane random_plane(const Stream& stream, std::uint64_t i) {
  const Eigen::Vector3d n(stream.gauss(i, 0), stream.gauss(i, 1), 0.1 * stream.gauss(i, 2));
  return {n.normalized(), 5.0 * stream.gauss(i, 3)};
}

TEST(PaperWalls, ClosestPointHasNoSide) {
  const Stream stream(1, "bim.generate");
  for (std::uint64_t i = 0; i < 200; ++i) {
    const Plane plane = random_plane(stream, i);
    const AnglePlane a = paper_form(plane, PaperVariant::printed),
                     b = paper_form(plane.flipped(), PaperVariant::printed);
    EXPECT_LT(paper_difference(a, b, PaperVariant::corrected).norm(), 1e-12);
    EXPECT_GE(a.d, 0.0);
    const Eigen::Vector3d foot = a.d * from_angles({a.azimuth, a.elevation, 0.0}).n;
    EXPECT_LT((foot - closest_point(plane)).norm(), 1e-9) << "the form of eq. 3";
    const AnglePlane front = paper_form(plane, PaperVariant::corrected),
                     back = paper_form(plane.flipped(), PaperVariant::corrected);
    EXPECT_GT(paper_difference(front, back, PaperVariant::corrected).norm(), 1.0);
  }
}

TEST(PaperWalls, AnglesAreWrappedOnlyWhereCorrected) {
  const AnglePlane a{pi - 0.01, 0.0, 1.0}, b{-pi + 0.01, 0.0, 1.0};
  EXPECT_NEAR(paper_difference(a, b, PaperVariant::corrected).x(), -0.02, 1e-12);
  EXPECT_NEAR(paper_difference(a, b, PaperVariant::printed).x(), 2.0 * pi - 0.02, 1e-12);
}

// Faces contain their own ends; the second ones as printed do not.
TEST(PaperWalls, SecondFacesAsPrintedAreElsewhere) {
  bim::Plan plan = house_plan();
  for (std::size_t f = 0; f < plan.faces.size(); ++f) plan.faces[f].side = f % 4 < 2 ? 0 : 1;  // of each box
  const PaperStorey corrected = storey_of(plan, PaperVariant::corrected),
                    printed = storey_of(plan, PaperVariant::printed);
  ASSERT_EQ(corrected.walls.size(), printed.walls.size());
  int elsewhere = 0;
  const auto off = [](const PaperWall& wall) {
    return std::abs(wall.plane_W.distance({wall.p0_W.x(), wall.p0_W.y(), 1.0}));
  };
  for (std::size_t i = 0; i < corrected.walls.size(); ++i) {
    EXPECT_LT(off(corrected.walls[i]), 1e-9);
    if (off(printed.walls[i]) > 0.1) ++elsewhere;
  }
  EXPECT_GT(elsewhere, static_cast<int>(corrected.walls.size()) / 4);
}

TEST(PaperWalls, ARoomIsItsBoxOrItsOutline) {
  bim::Plan plan = synthetic::plan_of(synthetic::one_room(6.0, 4.0));
  plan.rooms.front().polygon = {{0, 0}, {6, 0}, {6, 2}, {3, 2}, {3, 4}, {0, 4}};
  const PaperStorey storey = storey_of(plan, PaperVariant::corrected);
  EXPECT_EQ(storey.room_at({1.0, 3.0}, PaperVariant::corrected), 0);
  EXPECT_EQ(storey.room_at({5.0, 3.0}, PaperVariant::corrected), -1);
  EXPECT_EQ(storey.room_at({5.0, 3.0}, PaperVariant::printed), 0);
  EXPECT_EQ(storey.room_at({7.0, 3.0}, PaperVariant::printed), -1);
}

struct SensorPose2 {
  /// The plan stands away from W's origin, where the closest-point form is singular.
  SensorPose2(const bim::Plan& plan, const synthetic::House& house, const Pose& X_HR)
      : X_WR(Pose::from_xyz_yaw({10.0, 7.0, 0.0}, 0.0) * X_HR) {
    input.plan = std::make_shared<bim::Plan>(synthetic::moved(plan, X_WR * X_HR.inverse()));
    input.calibration = synthetic::calibration();
    PlanIndexConfig config;
    config.visibility_rays = 8;
    index = make_plan_index(*input.plan, std::nullopt, config);
    for (const PlaneObservation& plane : synthetic::house_scan(house, X_HR, X_HR).planes)
      if (plane.vertical) planes.push_back(plane);
  }
  [[nodiscard]] double weight(const PaperSwitches& switches, const Pose& at, int room = -1) const {
    return PaperFilter({}, switches, input, index).log_weight(0, room, at, planes);
  }
  Pose X_WR;
  MethodInput input;
  PlanIndex index;
  std::vector<PlaneObservation> planes;
};

SensorPose2 in_one_room() {
  const synthetic::House house = synthetic::one_room();
  return {synthetic::plan_of(house), house, Pose::from_xyz_yaw({2.5, 1.7, 0.5}, 0.3)};
}

TEST(PaperFilter, WeighsTheTruthHighestWhereverPlanesAreCompared) {
  const SensorPose2 stand = in_one_room();
  ASSERT_EQ(stand.planes.size(), 4U);
  const Stream stream(2, "bim.generate");
  for (const PaperVariant frame : {PaperVariant::printed, PaperVariant::corrected})
    for (const PaperVariant form : {PaperVariant::printed, PaperVariant::corrected})
      for (const PaperVariant planes : {PaperVariant::printed, PaperVariant::corrected}) {
        PaperSwitches switches;
        switches.frame = frame;
        switches.form = form;
        switches.planes = planes;
        switches.wrap = PaperVariant::corrected;
        const double truth = stand.weight(switches, stand.X_WR);
        for (std::uint64_t i = 0; i < 30; ++i) {
          const double angle = 2.0 * pi * stream.uniform(i, 0), way = 0.2 + 0.3 * stream.uniform(i, 1);
          Pose off = stand.X_WR;
          off.t += Eigen::Vector3d(way * std::cos(angle), way * std::sin(angle), 0.0);
          EXPECT_LT(stand.weight(switches, off), truth);
        }
      }
}

// Eq. 8-9: what is seen beyond a wall has a negative residual and weighs more the farther it is off.
TEST(PaperFilter, WeightAsPrintedGrowsAwayFromTheTruth) {
  const SensorPose2 stand = in_one_room();
  PaperSwitches switches;
  switches.weight = PaperVariant::printed;
  switches.frame = PaperVariant::corrected;
  double best = -1e9;
  for (double way = -0.5; way <= 0.5; way += 0.05) {
    Pose off = stand.X_WR;
    off.q = exp_so3({0.0, 0.0, way * 0.4}) * off.q;
    best = std::max(best, stand.weight(switches, off));
  }
  EXPECT_GT(best, stand.weight(switches, stand.X_WR) + 1e-3);
}

// Dropped observations cost nothing as printed: half of the planes drawn from another room leave the weight as it is.
TEST(PaperFilter, EveryPlaneCountsOnlyWhereCorrected) {
  SensorPose2 stand = in_one_room();
  PaperSwitches printed, corrected;
  corrected.planes = PaperVariant::corrected;
  const double before = stand.weight(printed, stand.X_WR), mixed_before = stand.weight(corrected, stand.X_WR);
  PlaneObservation stray = stand.planes.front();
  stray.plane_R.d += 1.5;
  stand.planes.push_back(stray);
  EXPECT_EQ(stand.weight(printed, stand.X_WR), before);
  EXPECT_LT(stand.weight(corrected, stand.X_WR), mixed_before - 0.5);
}

TEST(PaperFilter, TheRoomFactorLeavesOutWallsOfOtherRooms) {
  const synthetic::House house = synthetic::twin_rooms();
  bim::Plan plan = synthetic::plan_of(house);
  for (std::size_t f = 0; f < plan.faces.size(); ++f)
    for (bim::PlanRoom& room : plan.rooms) {
      const Eigen::Vector2d middle = 0.5 * (plan.faces[f].p0 + plan.faces[f].p1);
      if (boundary_distance(room.polygon, middle) < 0.05) room.faces.push_back(static_cast<int>(f));
    }
  SensorPose2 stand(plan, house, Pose::from_xyz_yaw({2.5, 1.7, 0.5}, 0.0));
  PaperSwitches with, without;
  without.rooms = false;
  EXPECT_EQ(stand.weight(with, stand.X_WR, 0), stand.weight(without, stand.X_WR, 0));
  EXPECT_LT(stand.weight(with, stand.X_WR, 1), stand.weight(without, stand.X_WR, 1)) << "told the other room";
}

TEST(SGraphLocalizationPaper, EverySwitchRunsAndNamesPlaces) {
  const synthetic::Recording recording = synthetic::biased_walk(2.5);
  const std::string corrected =
      "switches: {rooms: false, planes: corrected, form: corrected, frame: corrected, wrap: corrected, extent: "
      "corrected, classes: corrected, roomless: corrected, outline: corrected, yaw: corrected, resampling: corrected, "
      "tempering: corrected, convergence: corrected, handover: corrected}\nplan: {update_m: 0.4}\n"
      "filter: {particles: 1000}";
  const std::string printed =
      "switches: {increment: printed, weight: printed, faces: printed, state: printed}\nplan: {update_m: 0.4}\n"
      "filter: {particles: 1000}";
  for (const std::string& config : {std::string("plan: {update_m: 0.4}"), corrected, printed}) {
    const auto answers = synthetic::localize("s_graph_localization_paper", recording, house_plan(), true, config);
    for (const Output& output : answers.outputs)
      for (const Hypothesis& hypothesis : output.hypotheses) {
        ASSERT_TRUE(hypothesis.X_WR.t.allFinite());
        ASSERT_TRUE(hypothesis.covariance.allFinite());
      }
    EXPECT_FALSE(answers.outputs.back().hypotheses.empty()) << config;
  }
}

TEST(SGraphLocalizationPaper, SaysWhatIsMissing) {
  EXPECT_THROW(static_cast<void>(make_s_graph_localization_paper({})), InputError);
}

}  // namespace
}  // namespace plumbline::slam
