// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdio>
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
#include "bim/rays/scene.h"
#include "tests/bim/rays/box_mesh.h"

namespace plumbline::bim {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double range_max_m = 100.0;
constexpr std::size_t rays_a_turn = 16 * 1024;

/// Turns cast by each way of tracing; ci/full asks for more.
std::uint64_t turns() {
  const char* mrays = std::getenv("PLUMBLINE_SAME_BITS_MRAYS");
  return mrays == nullptr ? 12 : 1 + static_cast<std::uint64_t>(std::atof(mrays) * 1e6 / rays_a_turn);
}

/// Walls that are flush (end to end, and side by side with a common side), overlapping (crossing, corners, T), and
/// there twice with the same and with reversed triangles, on a floor under a ceiling, with furniture against them and
/// on each other; all turned by 37 degrees.
BuildingMesh awkward_building() {
  BuildingMesh mesh;
  const auto wall = [&](double x0, double y0, double x1, double y1) { add_box(mesh, {x0, y0, 0}, {x1, y1, 3}); };
  for (int i = 0; i < 4; ++i) {
    const double x = 4.0 * i;
    wall(x, 0, x + 0.2, 5);
    wall(x, 5, x + 0.2, 10);  // flush, end to end
    wall(x, 0, x + 4, 0.2);   // corners overlap
    wall(x, 9.8, x + 4, 10);
    wall(x, 4.9, x + 4, 5.1);                         // crosses
    if (i % 2 == 0) wall(x, 0, x + 0.2, 5);           // duplicate
    if (i % 2 == 1) wall(x + 0.2, 2, x + 0.35, 4);    // side by side: its side is in the other's
    if (i % 2 == 1) wall(x, 5.5, x + 0.2 + 5e-5, 8);  // half a tie distance beyond
    for (int k = 0; k < 6; ++k) {
      const double u = x + 0.6 + 0.5 * k;
      add_box(mesh, {u, 0.2, 0}, {u + 0.5, 0.8, 0.9});  // in a row along the wall
      add_box(mesh, {u + 0.1, 0.3, 0.9}, {u + 0.3, 0.5, 1.1}, 0.2 * k);
      add_box(mesh, {u, 6.0, 0}, {u + 0.3, 6.3, 0.4}, 0.3 * k);
    }
  }
  wall(16, 0, 16.2, 10);
  add_box(mesh, {0, 0, -0.2}, {16.2, 10, 0});
  add_box(mesh, {0, 0, 3}, {16.2, 10, 3.2});
  add_box(mesh, {0, 0, -0.2}, {8, 10, 0});  // a second slab in the first
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(37.0 * degree, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (Eigen::Vector3d& v : mesh.vertices) v = turn * v + Eigen::Vector3d(31.4, -27.2, 0.5);
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 7)
    mesh.triangles[i] = Eigen::Vector3i(mesh.triangles[i][1], mesh.triangles[i][2], mesh.triangles[i][0]);
  return mesh;
}

/// One turn of 16 rings x 1,024 columns in packets of 2 x 8 from a place of its own; every fourth one aims at places
/// where faces meet.
std::vector<Ray> turn_rays(std::uint64_t turn, const BuildingMesh& mesh) {
  const Stream stream(7, "bim.generate");
  const Eigen::Matrix3d R = Eigen::AngleAxisd(37.0 * degree, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const auto uniform = [&](std::uint32_t lane, double low, double high) {
    return low + (high - low) * stream.uniform(turn, lane);
  };
  const Eigen::Vector3d origin_W =
      R * Eigen::Vector3d(uniform(0, 0.3, 15.9), uniform(1, 0.3, 9.7), uniform(2, 0.3, 1.5)) +
      Eigen::Vector3d(31.4, -27.2, 0.5);
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
  scene.cast(rays, range_max_m, hits);
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

std::string one_line(const std::vector<std::uint64_t>& digests) {
  Digest all;
  for (const std::uint64_t digest : digests) all.add(digest);
  return all.hex();
}

/// Prints a row of ci/results/same_bits.tsv.
void print_row(const std::string& way, const std::vector<std::uint64_t>& digests) {
  std::printf("same_bits\t%s\t%.1f\t%s\n", way.c_str(), 1e-6 * static_cast<double>(digests.size() * rays_a_turn),
              one_line(digests).c_str());
}

TEST(SameBits, InstructionsAndPacketsAgree) {
  const BuildingMesh mesh = awkward_building();
  const std::vector<std::uint64_t> expected = digests(RayScene(mesh), mesh);
  print_row("default", expected);
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
      print_row(option + ", " + std::to_string(width) + " wide", found);
      ++compared;
    }
  EXPECT_GE(compared, 3);
}

TEST(SameBits, ThreadsAgree) {
  const BuildingMesh mesh = awkward_building();
  const RayScene scene(mesh);
  const std::vector<std::uint64_t> two = digests(scene, mesh, 2);
  EXPECT_EQ(two, digests(scene, mesh, 1));
  print_row("2 threads", two);
}

TEST(SameBits, ProcessesAgree) {
  const BuildingMesh mesh = awkward_building();
  int channel[2];
  ASSERT_EQ(pipe(channel), 0);
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const std::string text = one_line(digests(RayScene(mesh), mesh));
    const bool written = write(channel[1], text.data(), text.size()) == static_cast<ssize_t>(text.size());
    _exit(written ? 0 : 1);
  }
  const std::vector<std::uint64_t> own = digests(RayScene(mesh), mesh);
  std::array<char, 16> theirs{};
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_EQ(status, 0);
  ASSERT_EQ(read(channel[0], theirs.data(), theirs.size()), 16);
  close(channel[0]);
  close(channel[1]);
  EXPECT_EQ(std::string(theirs.data(), theirs.size()), one_line(own));
  print_row("2 processes", own);
}

}  // namespace
}  // namespace plumbline::bim
