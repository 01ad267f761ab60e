// SPDX-License-Identifier: Apache-2.0
// A recording may be larger than memory: it is read as a stream.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "sim/lidar/lidar.h"
#include "slam/io/packets/pcap.h"
#include "tests/bim/rays/box_mesh.h"
#include "tests/system/program.h"

namespace plumbline::system_tests {
namespace {

constexpr double record_bytes = 1264.0;  // of a packet in the capture
constexpr slam::Nanoseconds packet_ns = 24 * slam::vlp16::firing_period_ns;

/// Size of the longer capture; ci/full asks for more.
double gigabytes() {
  const char* asked = std::getenv("PLUMBLINE_STREAM_GB");
  return asked == nullptr ? 0.04 : std::atof(asked);
}

rusage used_by_children() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  return usage;
}

double cpu_s(const rusage& usage) {
  return static_cast<double>(usage.ru_utime.tv_sec) + 1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
}

/// A recording of so many packets: the given ones again and again, of a robot that stands.
void write_recording(const std::string& dir, const std::vector<slam::Vlp16Packet>& seen, std::size_t packets) {
  slam::PcapWriter writer(dir + "/lidar.pcap");
  for (std::size_t i = 0; i < packets; ++i) {
    slam::Vlp16Packet packet = seen[i % seen.size()];
    packet.stamp = static_cast<slam::Nanoseconds>(i) * packet_ns;
    const auto us_of_hour = static_cast<std::uint32_t>(packet.stamp / 1000 % 3'600'000'000);
    std::memcpy(&packet.payload[1200], &us_of_hour, sizeof us_of_hour);
    writer.add(packet);
  }
  writer.finish();
  std::ofstream odometry(dir + "/odometry.tum");
  for (slam::Nanoseconds t = 0; t <= static_cast<slam::Nanoseconds>(packets) * packet_ns; t += 100'000'000)
    odometry << t / 1'000'000'000 << '.' << t / 100'000'000 % 10 << " 0 0 0 0 0 0 1\n";
}

// Measured: 37 MB at 0.04 GB, 49 MB at 2 GB: 0.6 kB a scan, its pose and digests, of 96 kB of packets.
TEST(Stream, ALongRecordingNeedsHardlyMoreMemoryThanAShortOne) {
  if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY and PLUMBLINE_SOURCE are not set; run through ctest";
  const Folder folder;
  const std::string dir = folder / "walk";
  std::filesystem::create_directory(dir);
  const bim::BuildingMesh mesh = bim::box_room({10.0, 8.0, 3.0});
  const bim::RayScene scene(mesh);
  const std::vector<Pose> standing(1824, Pose::from_xyz_yaw({3.0, 3.5, 0.66}, 0.3));
  const auto seen = sim::Lidar(sim::LidarPreset::real, 600.0, 1, scene).sweep(0, standing).packets;

  const auto estimate = [&](double size_gb) {
    write_recording(dir, seen, static_cast<std::size_t>(1e9 * size_gb / record_bytes));
    const Outcome outcome = plumbline({"estimate", dir, "--method", "odometry", "-o", folder / "out", "--force"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return used_by_children();
  };
  const rusage before = estimate(0.01);
  const rusage after = estimate(gigabytes());
  const double scans = 1e9 * gigabytes() / record_bytes / 76.0;
  const double grown_mb = static_cast<double>(after.ru_maxrss - before.ru_maxrss) / 1024.0;
  EXPECT_LT(grown_mb, 8.0 + 0.001 * scans);
  std::printf("stream\t%.2f\t%.0f\t%.0f\t%.0f\n", gigabytes(), scans, static_cast<double>(after.ru_maxrss) / 1024.0,
              cpu_s(after) - cpu_s(before));
}

}  // namespace
}  // namespace plumbline::system_tests
