// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "bim/load/load.h"
#include "bim/mesh/mesh.h"
#include "sim/lidar/lidar.h"
#include "tests/data.h"
#include "tests/sim/lidar/heap_requests.h"

namespace plumbline::sim {
namespace {

class Allocations : public ::testing::TestWithParam<LidarPreset> {};

// A walk across a furnished house, turning; the first messages may grow the buffers.
TEST_P(Allocations, NoneAfterTheFirstScan) {
  const bim::Building building = bim::load_building(project_file("scenarios/library/house.plan.yaml"));
  const bim::BuildingMesh mesh = bim::build_mesh(building);
  const bim::RayScene scene(mesh);
  const RoomLookup rooms(building);
  const LidarConfig config = lidar_config(GetParam());
  const Lidar lidar(config, 600.0, 1, scene, surfaces_of(building, mesh, config.reflectivity), &rooms);
  constexpr std::int64_t firings = 1824;
  std::vector<Pose> X_WL(firings);
  Sweep sweep;
  for (std::int64_t message = 0; message < 12; ++message) {
    for (std::int64_t i = 0; i < firings; ++i) {
      const double walked = 0.06 * static_cast<double>(message * firings + i) / firings;
      X_WL[static_cast<std::size_t>(i)] = Pose::from_xyz_yaw({2.0 + walked, 2.0, 0.66}, 3.0 * walked);
    }
    const std::size_t before = heap_requests();
    lidar.sweep(message * firings, X_WL, sweep);
    if (message == 0) {
      EXPECT_GT(heap_requests(), before) << "the counter counts";
    } else {
      EXPECT_EQ(heap_requests(), before) << "message " << message;
    }
  }
}

std::string name_of(const ::testing::TestParamInfo<LidarPreset>& preset) {
  constexpr std::array names = {"ideal", "datasheet", "real", "full"};
  return names.at(static_cast<std::size_t>(preset.param));
}

INSTANTIATE_TEST_SUITE_P(Presets, Allocations,
                         ::testing::Values(LidarPreset::ideal, LidarPreset::real, LidarPreset::full), name_of);

}  // namespace
}  // namespace plumbline::sim
