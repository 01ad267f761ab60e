// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_map/structure.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "bim/mesh/mesh.h"
#include "bim/random/stream.h"
#include "slam/plan_map/plan_index.h"
#include "tests/slam/localization/house_plan.h"
#include "tests/slam/plan_map/box_mesh.h"

namespace plumbline::slam {
namespace {

class StructureAt : public testing::TestWithParam<int> {
 protected:
  const StoreyIndex storey_ = synthetic::storey_of(synthetic::plan_of(synthetic::corridor_house()));
};

TEST_P(StructureAt, RaysMeetTheFacesThatThePlanHas) {
  const Stream stream(3, "slam.localize.init");
  const auto tick = static_cast<std::uint64_t>(GetParam());
  const Eigen::Vector2d p = storey_.grid.cell_center(
      static_cast<int>(stream.uniform(tick, 0) * static_cast<double>(storey_.grid.cells() - 1)));
  std::vector<SensorRay> rays;
  for (int k = 0; k < 64; ++k) {
    const double angle = 0.1 * k + 0.01;
    rays.push_back({{std::cos(angle), std::sin(angle)}, 0.02 * (k % 5 - 2)});
  }
  std::vector<StructureHit> hits(rays.size());
  storey_.structure->cast({p.x(), p.y(), storey_.floor_z + 0.6}, rays, 30.0, hits);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const PlanHit expected =
        storey_.grid.cast(storey_.segments, {p, rays[i].direction, storey_.floor_z + 0.6, rays[i].slope}, 25.0);
    if (!hits[i].upright || hits[i].distance > 25.0) continue;
    EXPECT_NEAR(hits[i].distance, expected.distance, 1e-3);
    EXPECT_LT(hits[i].n.dot(rays[i].direction), 0.0);
    EXPECT_NEAR(hits[i].n.norm(), 1.0, 1e-9);
  }
}
INSTANTIATE_TEST_SUITE_P(Places, StructureAt, testing::Range(0, 20));

TEST(Structure, KnowsTheGroundAndWhatBarsTheWay) {
  const StoreyIndex storey = synthetic::storey_of(synthetic::plan_of(synthetic::one_room(6.0, 4.0)));
  const Eigen::Vector2d inside = storey.rooms.front().polygon[0] * 0.5 + storey.rooms.front().polygon[2] * 0.5;
  const Eigen::Vector3d middle(inside.x(), inside.y(), storey.floor_z + 0.45);
  const std::optional<double> ground = storey.structure->ground_below(middle, 1.0);
  ASSERT_TRUE(ground.has_value());
  EXPECT_NEAR(*ground, storey.floor_z, 1e-6);
  EXPECT_FALSE(storey.structure->ground_below(middle, 0.3).has_value());
  EXPECT_EQ(storey.structure->barrier(middle, middle + Eigen::Vector3d(0.5, 0.0, 0.0)), -1);
  EXPECT_GE(storey.structure->barrier(middle, middle + Eigen::Vector3d(20.0, 0.0, 0.0)), 0);
}

TEST(Structure, KnowsARailingByItsBars) {
  const auto box = [](double y, double width, double height) {
    return Eigen::AlignedBox3d(Eigen::Vector3d(2.0, y, 0.0), Eigen::Vector3d(2.02, y + width, height));
  };
  const Eigen::AlignedBox3d rail = box(-1.0, 2.0, 0.05);
  std::vector<Eigen::AlignedBox3d> railing{rail}, two_posts{rail};
  for (int i = 0; i < 16; ++i) railing.push_back(box(-1.0 + 0.12 * i, 0.02, 0.9));
  for (int i = 0; i < 2; ++i) two_posts.push_back(box(-1.0 + 1.8 * i, 0.02, 0.9));
  bim::BuildingMesh mesh;
  synthetic::add_boxes(bim::ElementKind::obstacle, railing, mesh);
  synthetic::add_boxes(bim::ElementKind::obstacle, {box(-1.0, 2.0, 0.9)}, mesh);
  synthetic::add_boxes(bim::ElementKind::obstacle, two_posts, mesh);
  const Structure structure(mesh);
  EXPECT_TRUE(structure.is_railing(0));
  EXPECT_FALSE(structure.is_railing(1));
  EXPECT_FALSE(structure.is_railing(2));
}

}  // namespace
}  // namespace plumbline::slam
