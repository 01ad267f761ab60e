// SPDX-License-Identifier: Apache-2.0
// Whole sweeps of the preset full, labels and intensities included, whatever Embree is told to use.
#include "tests/bim/rays/same_bits.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "bim/digest/digest.h"
#include "bim/digest/float_mode.h"
#include "bim/errors.h"
#include "bim/random/stream.h"
#include "bim/rays/ray_scene.h"
#include "sim/lidar/lidar.h"
#include "tests/bim/rays/awkward_building.h"

namespace plumbline::sim {
namespace {

constexpr std::size_t firings = 480;                     // of a sweep: 96 degrees
constexpr std::size_t rays_a_sweep = firings * 16 * 16;  // beams of the VLP-16 by sub-rays of a footprint

/// Sweeps by each way of tracing; ci/full asks for more.
std::uint64_t sweeps() {
  const char* mrays = std::getenv("PLUMBLINE_SAME_BITS_MRAYS");
  return mrays == nullptr ? 4 : 1 + static_cast<std::uint64_t>(std::atof(mrays) * 1e6 / rays_a_sweep);
}

/// Panes, mirrors and black ones among walls and furniture.
std::vector<Surface> surfaces_of(const bim::BuildingMesh& mesh) {
  std::vector<Surface> surfaces(mesh.elements.size());
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    surfaces[i].reflectivity = 0.05 + 0.1 * static_cast<double>(i % 9);
    if (i % 7 == 3) surfaces[i] = {0.05, 0.8, 0.1};
    if (i % 11 == 5) surfaces[i] = {0.1, 0.0, 0.7};
  }
  return surfaces;
}

std::uint64_t digest_of(const Lidar& lidar, std::uint64_t number) {
  const Stream stream(8, "bim.generate");
  const auto uniform = [&](std::uint32_t lane, double low, double high) {
    return low + (high - low) * stream.uniform(number, lane);
  };
  const Eigen::Vector3d from(uniform(0, 0.5, 15.0), uniform(1, 0.5, 9.0), uniform(2, 0.4, 1.4));
  const Eigen::Vector3d speed_mps(uniform(3, -1, 1), uniform(4, -1, 1), uniform(5, -0.1, 0.1));
  std::vector<Pose> X_WL;
  for (std::size_t f = 0; f < firings; ++f) {
    const double t = 55.296e-6 * static_cast<double>(f);
    X_WL.push_back(Pose::from_xyz_yaw(bim::in_awkward_building(from + t * speed_mps), uniform(6, 0, 6.28) + t));
  }
  const Sweep sweep = lidar.sweep(static_cast<std::int64_t>(number * firings), X_WL);
  Digest digest;
  for (const auto& words : {sweep.words, sweep.last})
    for (const slam::ReturnWord& word : words)
      digest.add(static_cast<std::int64_t>(word.distance)).add(static_cast<int>(word.reflectivity));
  for (const slam::Vlp16Packet& packet : sweep.packets) digest.add_bytes(packet.payload);
  const ReturnLabels& labels = sweep.labels;
  for (std::size_t i = 0; i < labels.element.size(); ++i)
    digest.add(labels.element[i])
        .add(labels.triangle[i])
        .add(labels.room[i])
        .add(static_cast<int>(labels.path[i]))
        .add(labels.point_W[i]);
  return digest.value();
}

class SweepSameBits : public ::testing::Test {
 protected:
  /// Digest of each sweep, in order; a sensor a thread, as one is for one thread at a time.
  std::vector<std::uint64_t> digests(const bim::RayScene& scene, std::size_t threads = 1) const {
    LidarConfig config = lidar_config(LidarPreset::full);
    config.returns = slam::ReturnMode::dual;
    std::vector<std::uint64_t> result(sweeps());
    std::vector<std::thread> pool;
    for (std::size_t t = 0; t < threads; ++t)
      pool.emplace_back([&, t] {
        set_float_mode();
        const Lidar lidar(config, 600.0, 3, scene, surfaces_of(mesh_));
        for (std::size_t i = t; i < result.size(); i += threads) result[i] = digest_of(lidar, i);
      });
    for (std::thread& thread : pool) thread.join();
    return result;
  }

  static void print_row(const std::string& way, const bim::Digests& digests) {
    bim::print_row("sweeps, " + way, 1e-6 * static_cast<double>(digests.size() * rays_a_sweep), digests);
  }

  const bim::BuildingMesh mesh_ = bim::awkward_building();
};

TEST_F(SweepSameBits, InstructionsPacketsAndThreadsAgree) {
  const bim::RayScene usual(mesh_);
  const std::vector<std::uint64_t> expected = digests(usual);
  print_row("default", expected);
  const std::vector<std::uint64_t> two = digests(usual, 2);
  EXPECT_EQ(two, expected) << "2 threads";
  print_row("2 threads", two);
  int compared = 0;
  for (const char* isa : {"sse4.2", "avx2", "avx512"})
    for (const std::size_t width : {1U, 8U, 16U}) {
      const std::string option = std::string("isa=") + isa;
      std::optional<bim::RayScene> scene;
      try {
        scene.emplace(mesh_, bim::RaySceneOptions{.embree = option, .width = width});
      } catch (const EnvironmentError&) {
        continue;  // this CPU has no such instructions
      }
      const std::vector<std::uint64_t> found = digests(*scene);
      EXPECT_EQ(found, expected) << isa << " " << width;
      print_row(option + ", " + std::to_string(width) + " wide", found);
      ++compared;
    }
  EXPECT_GE(compared, 3);
}

TEST_F(SweepSameBits, ProcessesAgree) {
  print_row("2 processes", bim::expect_same_in_another_process([&] { return digests(bim::RayScene(mesh_)); }));
}

}  // namespace
}  // namespace plumbline::sim
