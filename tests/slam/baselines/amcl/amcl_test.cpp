// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/amcl/amcl.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bim/errors.h"
#include "tests/slam/baselines/plan_walk.h"
#include "tests/slam/localization/house_plan.h"

namespace plumbline::slam {
namespace {

PlanIndex index_of(const synthetic::House& house) {
  PlanIndexConfig config;
  config.visibility_rays = 8;
  return make_plan_index(synthetic::plan_of(house), std::nullopt, config);
}

/// Four beams of a scanner in the middle of a room of 6 x 4 m, as long as they should be but for one, `off` too long.
ScanSlice cross(double off) {
  ScanSlice slice;
  slice.ends_H = {{3.0 + off, 0.0}, {0.0, 2.0}, {-3.0, 0.0}, {0.0, -2.0}};
  return slice;
}

// n = chi2 quantile(k - 1) / (2 eps) by tables; Fox's approximation (Wilson, Hilferty) of it is good to 0.5 %.
TEST(Amcl, KldLimitIsAChiSquareQuantile) {
  AmclFilterConfig config;
  config.min_particles = 1;
  config.max_particles = 100000;
  config.pf_z = 2.3263;
  EXPECT_NEAR(kld_limit(10, config), 21.666 / 0.1, 2.0);
  EXPECT_NEAR(kld_limit(30, config), 49.588 / 0.1, 3.0);
  EXPECT_NEAR(kld_limit(100, config), 134.642 / 0.1, 7.0);
  config.pf_z = 3.0902;
  EXPECT_NEAR(kld_limit(10, config), 27.877 / 0.1, 3.0);
  config.min_particles = 500;
  EXPECT_EQ(kld_limit(3, config), 500);
  EXPECT_EQ(kld_limit(1, config), 100000);
}

TEST(Amcl, SensorModelsAreTheReferencesOwn) {
  const PlanIndex index = index_of(synthetic::one_room());
  const Pose2 X_IH{{3.0, 2.0}, 0.0};
  LikelihoodFieldConfig field;
  field.cell_m = 0.01;
  const double narrow = 0.5 * std::exp(-0.5 * 0.3 * 0.3 / 0.04) + 0.005, wide = 0.505;
  AmclFilterConfig config;
  const AmclFilter flat(config, field, index, 1);
  EXPECT_NEAR(flat.likelihood(0, X_IH, cross(0.0)), 1.0 + 4.0 * std::pow(wide, 3), 2e-3);
  EXPECT_NEAR(flat.likelihood(0, X_IH, cross(-0.3)), 1.0 + 3.0 * std::pow(wide, 3) + std::pow(narrow, 3), 1e-2);
  config.model = BeamModel::likelihood_field_prob;
  const AmclFilter sharp(config, field, index, 1);
  EXPECT_NEAR(sharp.likelihood(0, X_IH, cross(-0.3)), std::pow(wide, 3) * narrow, 2e-3);
  EXPECT_EQ(sharp.likelihood(0, X_IH, {}), 1.0);
}

TEST(Amcl, StartsOverAllFreeSpaceAndKeepsItsCount) {
  const PlanIndex index = index_of(synthetic::corridor_house());
  AmclFilter filter({}, {}, index, 5);
  filter.start(std::nullopt, 0.0, 1);
  ASSERT_EQ(filter.particles().size(), 2000U);
  const StoreyIndex& storey = index.storeys.front();
  double area = 0.0, cosine = 0.0;
  std::vector<double> count(storey.rooms.size(), 0.0);
  for (const LocalParticle& particle : filter.particles()) {
    const int room = storey.room_at(particle.X_IH.t);
    if (room >= 0) ++count[static_cast<std::size_t>(room)];
    cosine += std::cos(particle.X_IH.yaw) / 2000.0;
  }
  for (const LocalRoom& room : storey.rooms) area += std::abs(signed_area(room.polygon));
  for (std::size_t r = 0; r < count.size(); ++r) {
    const double share = std::abs(signed_area(storey.rooms[r].polygon)) / area;
    EXPECT_NEAR(count[r] / 2000.0, share, 4.0 * std::sqrt(share * (1.0 - share) / 2000.0) + 0.01);
  }
  EXPECT_NEAR(cosine, 0.0, 4.0 / std::sqrt(2.0 * 2000.0));
  filter.update_weights({});
  EXPECT_NEAR(effective_size(filter.particles()), 2000.0, 1e-6) << "without beams";
}

TEST(Amcl, MovesByItsMotionModel) {
  const PlanIndex index = index_of(synthetic::one_room());
  AmclFilterConfig config;
  config.max_particles = 20000;
  AmclFilter filter(config, {}, index, 5);
  filter.start(0.0, 0.0, 1);
  const ParticleSet before = filter.particles();
  filter.predict({{1.0, 0.0}, 0.5}, 2);
  double ahead = 0.0, ahead2 = 0.0, yaw = 0.0, yaw2 = 0.0;
  const double n = static_cast<double>(before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Eigen::Vector2d way = filter.particles()[i].X_IH.t - before[i].X_IH.t;
    ahead += way.norm() / n;
    ahead2 += way.squaredNorm() / n;
    yaw += filter.particles()[i].X_IH.yaw / n;
    yaw2 += std::pow(filter.particles()[i].X_IH.yaw - 0.5, 2) / n;
  }
  // Alphas multiply variances: 0.2 of the way squared and, for the turn of 0.5 rad at the end, 0.2 * 0.25 more.
  const double variance = 0.2 * 1.0 + 0.2 * 0.25;
  EXPECT_NEAR(ahead2, 1.0 + variance, 0.05);
  EXPECT_NEAR(yaw, 0.5, 0.05);
  EXPECT_NEAR(yaw2, 0.2 * 1.0 + (0.2 * 0.25 + 0.2 * 1.0), 0.05);
  EXPECT_LT(ahead, 1.1);
}

TEST(Amcl, RecoversOnlyWhenToldTo) {
  const PlanIndex index = index_of(synthetic::one_room());
  AmclFilterConfig config;
  const auto share = [&](double slow, double fast) {
    config.recovery_alpha_slow = slow;
    config.recovery_alpha_fast = fast;
    AmclFilter filter(config, {}, index, 5);
    filter.start(0.0, 0.01, 1);
    ScanSlice nowhere;
    nowhere.ends_H.assign(4, Eigen::Vector2d(100.0, 0.0));
    double most = 0.0;  // resampling with a share forgets the averages
    for (std::uint64_t tick = 2; tick < 42; ++tick) {
      filter.update_weights(tick < 12 ? cross(0.0) : nowhere);
      most = std::max(most, filter.random_share());
      filter.resample(tick);
    }
    return most;
  };
  EXPECT_EQ(share(0.0, 0.0), 0.0);
  EXPECT_GT(share(0.01, 0.5), 0.01);
}

TEST(Amcl, HoldsTheRightPlaceWithACompass) {
  const synthetic::Recording recording = synthetic::biased_walk(6.0);
  const bim::Plan plan = synthetic::plan_of(synthetic::corridor_house());
  const std::string tuned =
      "filter: {alpha1: 0.05, alpha2: 0.01, alpha3: 0.02, alpha4: 0.02, model: likelihood_field_prob, z_hit: 0.8, "
      "z_rand: 0.2, range_max_m: 25}";
  const auto answers = synthetic::localize("amcl", recording, plan, true, tuned);
  EXPECT_EQ(answers.outputs.back().state, State::converged);
  EXPECT_LT(synthetic::last_error(answers, recording), 0.3);
  EXPECT_EQ(answers.estimate.trajectory.size(), recording.scans.size());
}

TEST(Amcl, SaysWhatIsMissing) {
  MethodInput input;
  EXPECT_THROW(static_cast<void>(make_amcl(input)), InputError);
  bim::Plan plan = synthetic::plan_of(synthetic::one_room());
  plan.rooms.clear();
  input.plan = std::make_shared<bim::Plan>(plan);
  EXPECT_THROW(static_cast<void>(make_amcl(input)), InputError);
}

}  // namespace
}  // namespace plumbline::slam
