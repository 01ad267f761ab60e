// SPDX-License-Identifier: Apache-2.0
#include "tests/bim/rays/same_bits.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "bim/digest/digest.h"
#include "bim/digest/float_mode.h"
#include "bim/errors.h"
#include "bim/random/stream.h"
#include "bim/rays/ray_scene.h"
#include "tests/bim/rays/awkward_building.h"

namespace plumbline::bim {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double reach_m = 100.0;
constexpr std::size_t rays_a_turn = 16 * 1024;

/// Turns cast by each way of tracing; ci/full asks for more.
std::uint64_t turns() {
  const char* mrays = std::getenv("PLUMBLINE_SAME_BITS_MRAYS");
  return mrays == nullptr ? 12 : 1 + static_cast<std::uint64_t>(std::atof(mrays) * 1e6 / rays_a_turn);
}

/// One turn of 16 rings x 1,024 columns in packets of 2 x 8 from a place of its own; every fourth one aims at places
/// where faces meet.
std::vector<Ray> turn_rays(std::uint64_t turn, const BuildingMesh& mesh) {
  const Stream stream(7, "bim.generate");
  const auto uniform = [&](std::uint32_t lane, double low, double high) {
    return low + (high - low) * stream.uniform(turn, lane);
  };
  const Eigen::Vector3d origin_W =
      in_awkward_building({uniform(0, 0.3, 15.9), uniform(1, 0.3, 9.7), uniform(2, 0.3, 1.5)});
  const double yaw = uniform(3, 0.0, 2.0 * std::numbers::pi);
  std::vector<Ray> rays;
  rays.reserve(rays_a_turn);
  for (std::uint32_t i = 0; i < rays_a_turn; ++i) {
    const std::uint32_t column = i / 128 * 8 + i % 8, ring = i / 16 % 8 * 2 + i / 8 % 2;
    Eigen::Vector3d direction;
    if (turn % 4 == 3) {
      const auto t = static_cast<std::size_t>(stream.uniform(turn, i, 1) * static_cast<double>(mesh.triangles.size()));
      const Eigen::Vector3i& corner = mesh.triangles[t];
      const Eigen::Vector3d& a = mesh.vertices[static_cast<std::size_t>(corner[0])];
      const Eigen::Vector3d& b = mesh.vertices[static_cast<std::size_t>(corner[1])];
      direction = a + stream.uniform(turn, i, 2) * (b - a) - origin_W;
    } else {
      const double azimuth = yaw + 2.0 * std::numbers::pi * column / 1024.0, elevation = (2.0 * ring - 15.0) * degree;
      direction = {std::cos(elevation) * std::cos(azimuth), -std::cos(elevation) * std::sin(azimuth),
                   std::sin(elevation)};
    }
    rays.push_back({origin_W, direction.normalized()});
  }
  return rays;
}

std::uint64_t digest_of(const RayScene& scene, const BuildingMesh& mesh, std::uint64_t turn) {
  const std::vector<Ray> rays = turn_rays(turn, mesh);
  std::vector<Hit> hits(rays.size());
  scene.cast(rays, reach_m, hits);
  Digest digest;
  for (const Hit& hit : hits) digest.add(hit.range_m).add(hit.element).add(hit.triangle).add(hit.normal_W);
  return digest.value();
}

/// Digest of each turn, in order, from so many threads.
std::vector<std::uint64_t> digests(const RayScene& scene, const BuildingMesh& mesh, std::size_t threads = 1) {
  std::vector<std::uint64_t> result(turns());
  std::vector<std::thread> pool;
  for (std::size_t t = 0; t < threads; ++t)
    pool.emplace_back([&, t] {
      set_float_mode();
      for (std::size_t turn = t; turn < result.size(); turn += threads) result[turn] = digest_of(scene, mesh, turn);
    });
  for (std::thread& thread : pool) thread.join();
  return result;
}

double mrays(const Digests& digests) { return 1e-6 * static_cast<double>(digests.size() * rays_a_turn); }

TEST(SameBits, InstructionsAndPacketsAgree) {
  const BuildingMesh mesh = awkward_building();
  const std::vector<std::uint64_t> expected = digests(RayScene(mesh), mesh);
  print_row("default", mrays(expected), expected);
  int compared = 0;
  for (const char* isa : {"sse4.2", "avx2", "avx512"})
    for (const std::size_t width : {1U, 8U, 16U}) {
      const std::string option = std::string("isa=") + isa;
      std::optional<RayScene> scene;
      try {
        scene.emplace(mesh, RaySceneOptions{.embree = option, .width = width});
      } catch (const EnvironmentError&) {
        continue;  // this CPU has no such instructions
      }
      const std::vector<std::uint64_t> found = digests(*scene, mesh);
      EXPECT_EQ(found, expected) << isa << " " << width;
      print_row(option + ", " + std::to_string(width) + " wide", mrays(found), found);
      ++compared;
    }
  EXPECT_GE(compared, 3);
}

TEST(SameBits, ThreadsAgree) {
  const BuildingMesh mesh = awkward_building();
  const RayScene scene(mesh);
  const std::vector<std::uint64_t> two = digests(scene, mesh, 2);
  EXPECT_EQ(two, digests(scene, mesh, 1));
  print_row("2 threads", mrays(two), two);
}

TEST(SameBits, ProcessesAgree) {
  const BuildingMesh mesh = awkward_building();
  const Digests own = expect_same_in_another_process([&] { return digests(RayScene(mesh), mesh); });
  print_row("2 processes", mrays(own), own);
}

}  // namespace
}  // namespace plumbline::bim
