// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/wall_matches.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "slam/localization/associate.h"
#include "tests/slam/localization/house_plan.h"
#include "tests/slam/localization/house_scan.h"

namespace plumbline::slam {
namespace {

std::vector<WallMatch> matches_in(const bim::Plan& plan, const synthetic::House& house, const Pose& X_WR) {
  const PlanIndex index = make_plan_index(plan, "ground", {});
  const synthetic::HouseScan seen = synthetic::house_scan(house, X_WR, Pose{});
  const Pose X_IR = index.X_WI.inverse() * X_WR;
  const StoreyIndex& storey = index.storeys.front();
  return wall_matches(plan, storey, associate_walls(storey, seen.scan, seen.planes, X_IR, Eigen::Matrix2d::Zero(), {}));
}

TEST(WallMatches, NameTheFacesThatThePatchesLieOn) {
  const synthetic::House house = synthetic::corridor_house();
  bim::Plan plan = synthetic::plan_of(house);
  const Pose X_WR = Pose::from_xyz_yaw({2.0, 4.0, 0.46}, 0.7);
  const std::vector<WallMatch> matches = matches_in(plan, house, X_WR);
  ASSERT_GE(matches.size(), 4U);  // the four walls of the room
  for (const WallMatch& match : matches) {
    ASSERT_FALSE(match.faces.empty());
    EXPECT_TRUE(std::is_sorted(match.faces.begin(), match.faces.end()));
    const Eigen::Vector3d p0_W = X_WR * match.p0_R, p1_W = X_WR * match.p1_R;
    for (const int id : match.faces) {
      const bim::PlanFace& face = plan.faces[static_cast<std::size_t>(id)];
      EXPECT_NEAR(face.plane_W.distance(0.5 * (p0_W + p1_W)), 0.0, 0.03);  // range noise of 30 mm, averaged
      EXPECT_GT((p1_W - p0_W).head<2>().dot(face.p1 - face.p0), 0.0);
    }
  }
  // Ids, not indices into the list.
  std::reverse(plan.faces.begin(), plan.faces.end());
  const std::vector<WallMatch> reversed = matches_in(plan, house, X_WR);
  ASSERT_EQ(reversed.size(), matches.size());
  for (std::size_t i = 0; i < matches.size(); ++i) EXPECT_EQ(reversed[i].faces, matches[i].faces);
}

TEST(WallMatches, AWallOfSeveralPiecesHasThemAll) {
  const synthetic::House house = synthetic::corridor_house();
  const bim::Plan plan = synthetic::plan_of(house);
  // The corridor's upper wall has doors at 2.2, 7.0 and 11.5 m: pieces on one line.
  const std::vector<WallMatch> matches = matches_in(plan, house, Pose::from_xyz_yaw({5.0, 1.1, 0.46}, 0.0));
  const bool found = std::any_of(matches.begin(), matches.end(), [&](const WallMatch& match) {
    const Eigen::Vector3d n_W = plan.faces[static_cast<std::size_t>(match.faces.front())].plane_W.n;
    return n_W.y() < -0.9 && match.faces.size() >= 4;
  });
  EXPECT_TRUE(found);
}

}  // namespace
}  // namespace plumbline::slam
