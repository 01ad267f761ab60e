// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/global_localizer.h"

#include <gtest/gtest.h>

#include <memory>

#include "slam/plan_map/plan_mesh.h"
#include "tests/slam/localization/house_plan.h"
#include "tests/slam/localization/house_scan.h"

namespace plumbline::slam {
namespace {

/// Share of particles with a twin at the same pose in the other set.
double shared(const ParticleSet& a, const ParticleSet& b) {
  double count = 0.0;
  for (const LocalParticle& p : a)
    for (const LocalParticle& q : b)
      if (p.X_IH.t == q.X_IH.t) {
        count += 1.0;
        break;
      }
  return count / static_cast<double>(a.size());
}

TEST(GlobalLocalizer, DrawsOtherNumbersAfterARestart) {
  const synthetic::House house = synthetic::corridor_house();
  const PlanIndex index = make_plan_index(synthetic::plan_of(house), "ground", {});
  const LocalizationScan scan = synthetic::house_scan(house, Pose::from_xyz_yaw({7.0, 1.1, 0.46}, 0.3), Pose{}).scan;
  GlobalLocalizer search({}, 7), again({}, 7);
  search.update(index, {}, scan);
  again.update(index, {}, scan);
  const ParticleSet first = search.particles();
  ASSERT_FALSE(first.empty());
  EXPECT_EQ(shared(first, again.particles()), 1.0);
  search.restart();
  search.update(index, {}, scan);
  EXPECT_EQ(shared(first, search.particles()), 0.0);
}

// The way walked while nothing was searched would count as one straight step, through walls.
TEST(GlobalLocalizer, KnowsNothingOfTheWayBeforeARestart) {
  const synthetic::House house = synthetic::corridor_house();
  const PlanIndex index = make_plan_index(synthetic::plan_of(house), "ground", {});
  const Pose X_OW = Pose::from_xyz_yaw({9.0, 4.0, 0.0}, 0.5);
  const auto seen = [&](double x, const Pose& X_OR) {
    return synthetic::house_scan(house, Pose::from_xyz_yaw({x, 1.1, 0.46}, 0.3), X_OR).scan;
  };
  GlobalLocalizer walked({}, 7), stood({}, 7);
  walked.update(index, {}, seen(3.0, Pose{}));
  stood.update(index, {}, seen(3.0, X_OW * Pose::from_xyz_yaw({3.0, 1.1, 0.46}, 0.3)));
  walked.restart();
  stood.restart();
  for (int i = 0; i < 16; ++i) {
    const double x = 3.0 + 0.25 * i;
    const LocalizationScan scan = seen(x, X_OW * Pose::from_xyz_yaw({x, 1.1, 0.46}, 0.3));
    const std::vector<StageDigest> a = walked.update(index, {}, scan), b = stood.update(index, {}, scan);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k) EXPECT_EQ(a[k].digest, b[k].digest) << a[k].stage << " " << i;
  }
  EXPECT_FALSE(stood.hypotheses().empty());
}

/// Of a robot that goes along the corridor at an angle of 0.3 rad.
StartPrior known_heading(const PlanIndex& index) {
  StartPrior start;
  start.yaw_I = (index.X_WI.inverse() * Pose::from_xyz_yaw({0.0, 0.0, 0.0}, 0.3)).yaw();
  return start;
}

/// The plan's walls alone, without anything to stand on.
std::shared_ptr<const Structure> without_slabs(const StoreyIndex& storey) {
  bim::BuildingMesh mesh = plan_mesh(storey);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (mesh.elements[static_cast<std::size_t>(mesh.element[i])].kind == bim::ElementKind::slab) continue;
    mesh.triangles[kept] = mesh.triangles[i];
    mesh.element[kept++] = mesh.element[i];
  }
  mesh.triangles.resize(kept);
  mesh.element.resize(kept);
  return std::make_shared<const Structure>(mesh);
}

TEST(GlobalLocalizer, IsSureOnlyWhereThePlanHasAFloor) {
  const synthetic::House house = synthetic::corridor_house();
  const PlanIndex whole = make_plan_index(synthetic::plan_of(house), "ground", {});
  PlanIndex bare = whole;
  // Found in the whole plan, as poses are sought in rooms, then followed in the other.
  const auto state_after_walk = [&] {
    constexpr int found_after = 3, steps = 24;
    const StartPrior start = known_heading(whole);
    GlobalLocalizer search({}, 7);
    for (int i = 0; i < steps; ++i) {
      const Pose X_WR = Pose::from_xyz_yaw({3.0 + 0.25 * i, 1.1, 0.46}, 0.3);
      search.update(i < found_after ? whole : bare, start, synthetic::house_scan(house, X_WR, X_WR).scan);
    }
    return search.state();
  };
  StoreyIndex& storey = bare.storeys.front();
  storey.structure = without_slabs(storey);
  EXPECT_EQ(state_after_walk(), State::converged);  // a room needs no slab
  const Eigen::Vector3d on_the_way(5.0, 1.1, 0.0);
  storey.rooms.erase(storey.rooms.begin() + storey.room_at((whole.X_WI.inverse() * on_the_way).head<2>()));
  EXPECT_NE(state_after_walk(), State::converged);
}

// The moving average over the last scans forgets them: in a plan's mirror image a room like one of its own was enough.
TEST(GlobalLocalizer, IsNotSureByTheLastScansAloneWhereThoseBeforeDidNotFit) {
  const synthetic::House house = synthetic::corridor_house(), other = synthetic::one_room(30.0, 9.0);
  const PlanIndex index = make_plan_index(synthetic::plan_of(house), "ground", {});
  const auto state_after_walk = [&](int strange) {
    constexpr int found_after = 3, steps = 36;
    const StartPrior start = known_heading(index);
    GlobalLocalizer search({}, 7);
    for (int i = 0; i < steps; ++i) {
      const Pose X_WR = Pose::from_xyz_yaw({2.0 + 0.2 * i, 1.1, 0.46}, 0.3);
      const bool fits = i < found_after || i >= found_after + strange;
      search.update(index, start, synthetic::house_scan(fits ? house : other, X_WR, X_WR).scan);
    }
    EXPECT_EQ(search.hypotheses().size(), 1U);
    EXPECT_LT((search.hypotheses().front().X_IH.t -
               (index.X_WI.inverse() * Eigen::Vector3d(2.0 + 0.2 * (steps - 1), 1.1, 0.46)).head<2>())
                  .norm(),
              0.1);
    return search.state();
  };
  EXPECT_EQ(state_after_walk(0), State::converged);
  EXPECT_NE(state_after_walk(12), State::converged);
}

// Between two rows of shelves that the plan lacks one of them looks like the hall's wall.
TEST(GlobalLocalizer, IsNotSureWhereOneFrontAloneFixesThePose) {
  synthetic::House hall = synthetic::one_room(40.0, 24.0);
  for (double x = 8.0; x < 34.0; x += 4.0) hall.boxes.push_back({{x, 23.5, 0.0}, {x + 0.5, 24.0, hall.height_m}});
  synthetic::House built = hall;
  for (const double y : {9.6, 13.8}) built.boxes.push_back({{6.0, y, 0.0}, {34.0, y + 1.1, 2.7}});
  const PlanIndex index = make_plan_index(synthetic::plan_of(hall), "ground", {});
  const StartPrior start{(index.X_WI.inverse() * Pose::from_xyz_yaw({0.0, 0.0, 0.0}, 0.05)).yaw()};
  const auto was_sure = [&](const GlobalLocalizerConfig& config) {
    GlobalLocalizer search(config, 7);
    bool sure = false;
    for (int i = 0; i < 24; ++i) {
      const Pose X_WR = Pose::from_xyz_yaw({18.0 + 0.25 * i, 12.3, 0.46}, 0.05);
      search.update(index, start, synthetic::house_scan(built, X_WR, X_WR).scan);
      sure = sure || search.state() == State::converged;
    }
    return sure;
  };
  EXPECT_FALSE(was_sure({}));
  GlobalLocalizerConfig without;
  without.proposals.slide_count = 0;
  EXPECT_TRUE(was_sure(without)) << "of a pose by the hall's wall";
  GlobalLocalizerConfig counts_whole;
  counts_whole.comparison.front_cap = 1e6;
  EXPECT_TRUE(was_sure(counts_whole)) << "as the front counts like any object";
}

}  // namespace
}  // namespace plumbline::slam
