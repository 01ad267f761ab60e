// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <cstdio>
#include <filesystem>

#include "scenarios/app/bench/bench.h"
#include "scenarios/app/bench/registration_timing.h"
#include "slam/io/clouds/cloud_file.h"

namespace plumbline::scenarios {

namespace {

constexpr double least_factor = 4.0;  ///< of PCL's time over ours

/// Of the pair in the data folder, as its authors give it.
Pose true_pose() {
  Eigen::Matrix3d R;
  R << 0.999925, 0.0121483, -0.00177009, -0.0121523, 0.999924, -0.00228657, 0.00174218, 0.00230791, 0.999996;
  return {Eigen::Quaterniond(R).normalized(), {0.488882, 0.121214, -0.0253342}};
}

}  // namespace

std::vector<BenchRow> bench_registration(const BenchSetting& setting) {
  const std::string folder = setting.data_dir + "/clouds/";
  if (setting.data_dir.empty() || !std::filesystem::exists(folder + "small_gicp_target.ply")) {
    std::fputs("bench: no clouds/small_gicp_*.ply in the data folder; registration is left out\n", stderr);
    return {};
  }
  const std::vector<Eigen::Vector3f> target = slam::read_cloud_points(folder + "small_gicp_target.ply");
  const std::vector<Eigen::Vector3f> source = slam::read_cloud_points(folder + "small_gicp_source.ply");
  const auto error = [](const Pose& X) { return true_pose().inverse() * X; };
  std::vector<double> ours_ms, pcl_ms, faster;
  Pose ours, pcl;
  for (int k = 0; k < setting.repetitions; ++k) {
    setting.step();
    const Registered a = register_ours(target, source);
    ours_ms.push_back(a.cpu_ms);
    ours = error(a.X_TS);
    const Registered b = register_pcl(target, source);
    pcl_ms.push_back(b.cpu_ms);
    faster.push_back(b.cpu_ms / a.cpu_ms);
    pcl = error(b.X_TS);
  }
  const double ours_rad = log_so3(ours.q).norm(), pcl_rad = log_so3(pcl.q).norm();
  std::vector<BenchRow> rows = {make_row("slam.registration_ms", "ms", ours_ms)};
  rows.push_back(make_row("slam.registration_pcl_ms", "ms", pcl_ms));
  rows.push_back(make_row("slam.registration_vs_pcl", "x", faster, BenchLimit{least_factor, false, true}));
  rows.push_back(make_row("slam.registration_error_m", "m", {ours.t.norm()}, BenchLimit{pcl.t.norm(), true, true}));
  rows.push_back(make_row("slam.registration_error_rad", "rad", {ours_rad}, BenchLimit{pcl_rad, true, true}));
  return rows;
}

}  // namespace plumbline::scenarios
